#pragma once
#include "scene/import.h"
#include "tests/source_folder.h"

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

// Every importable file outside bad/, whose files are not meant to load, in order.
inline std::vector<std::filesystem::path> modelFiles() {
    std::vector<std::filesystem::path> files = importableFiles(modelsFolder());
    std::erase_if(files, [](const std::filesystem::path& file) {
        return *file.lexically_relative(modelsFolder()).begin() == "bad";
    });
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
