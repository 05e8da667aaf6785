#pragma once
#include "scene/import.h"
#include "tests/source_folder.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <gtest/gtest.h>
#include <string_view>
#include <vector>

namespace lodestone::tests {

// The folder of real models beside the source tree; it need not exist.
inline std::filesystem::path modelsFolder() {
    return sourceFolder().parent_path() / "shared" / "models";
}

// Every importable file outside bad/, in order. The folder exists.
inline std::vector<std::filesystem::path> modelFiles() {
    std::vector<std::filesystem::path> files;
    for (const char* folder : {"instanced", "textured", "features", "meshes"})
        for (const auto& entry :
             std::filesystem::recursive_directory_iterator(modelsFolder() / folder)) {
            std::string extension = entry.path().extension().string();
            std::ranges::transform(extension, extension.begin(), [](unsigned char c) {
                return static_cast<char>(std::tolower(c));
            });
            if (entry.is_regular_file() &&
                std::ranges::find(importExtensions(), extension) != importExtensions().end())
                files.push_back(entry.path());
        }
    std::ranges::sort(files);
    return files;
}

// A test that needs the real models: skipped where the folder is absent, failed where it is absent
// and CI=true, so that a sweep is never silently lost.
class ModelsTest : public ::testing::Test {
protected:
    void SetUp() override {
        if (std::filesystem::is_directory(modelsFolder()))
            return;
        const char* ci = std::getenv("CI");
        if (ci != nullptr && std::string_view(ci) == "true")
            FAIL() << "no models in " << modelsFolder();
        GTEST_SKIP() << "no models in " << modelsFolder() << ", sweep skipped";
    }
};

} // namespace lodestone::tests
