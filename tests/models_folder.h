#pragma once
#include <cstdlib>
#include <filesystem>
#include <gtest/gtest.h>
#include <string_view>

namespace lodestone::tests {

// The folder of real models beside the source tree; it need not exist.
inline std::filesystem::path modelsFolder() {
    return std::filesystem::path(LODESTONE_SOURCE_DIR).parent_path() / "shared" / "models";
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
