#include "render/view.h"
#include "tests/render/headless_test.h"
#include "tests/source_folder.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <string>

namespace lodestone {
namespace {

namespace fs = std::filesystem;

// A copy of the shaders that LODESTONE_SHADER_DIR points at.
class ShaderFolderTest : public tests::HeadlessTest {
protected:
    void SetUp() override {
        HeadlessTest::SetUp();
        if (!context_)
            return;
        const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
        folder_ = fs::path(testing::TempDir()) / ("lodestone_shaders_" + std::string(test.name()));
        fs::remove_all(folder_);
        fs::copy(tests::sourceFolder() / "shaders", folder_);
        ASSERT_EQ(setenv("LODESTONE_SHADER_DIR", folder_.c_str(), 1), 0);
    }

    void TearDown() override {
        unsetenv("LODESTONE_SHADER_DIR");
        fs::remove_all(folder_);
    }

    // Puts text before that line.
    void insert(const std::string& file, int line, const std::string& text) const {
        std::ifstream in(folder_ / file);
        std::string all;
        std::string row;
        for (int number = 1; std::getline(in, row); ++number)
            all += (number == line ? text + "\n" : "") + row + "\n";
        in.close();
        std::ofstream(folder_ / file) << all;
    }

    // Draws a triangle with the shaders of the folder.
    Result<DrawReport> draw() {
        const Result<Renderer> renderer = Renderer::create(*context_);
        if (!renderer)
            return tl::unexpected(renderer.error());
        auto geometry = std::make_shared<Geometry>();
        geometry->positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
        geometry->indices = {0, 1, 2};
        auto scene = std::make_shared<Scene>();
        scene->submeshes.push_back({"triangle", {{PrimitiveMode::Triangles, geometry}}});
        scene->instances.emplace_back();
        Result<GpuScene> gpu = GpuScene::create(*renderer, scene);
        Result<View> view = View::create(*renderer);
        if (!gpu || !view)
            return fail(ErrorKind::Failed, "no scene or view");
        LodHandle lod;
        if (const auto uploaded = gpu->update(lod, fullLod(*scene)); !uploaded)
            return tl::unexpected(uploaded.error());
        View::Input input;
        input.scene = &*gpu;
        input.lod = &lod;
        input.size = {16, 16};
        return view->draw(input);
    }

    fs::path folder_;
};

TEST_F(ShaderFolderTest, ShadersOfTheFolderAreUsed) {
    const Result<DrawReport> report = draw();
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_EQ(report->draw_calls, 1u);
}

TEST_F(ShaderFolderTest, BrokenShaderIsNamedWithFileAndLineInOneLine) {
    insert("scene.frag", 20, "nonsense here;");
    const Result<DrawReport> report = draw();
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().kind, ErrorKind::Failed);
    EXPECT_EQ(report.error().message.find("shaders/scene.frag:20: "), 0u) << report.error().message;
    EXPECT_EQ(report.error().message.find('\n'), std::string::npos);
}

TEST_F(ShaderFolderTest, BrokenCommonPartIsNamedAsItself) {
    insert("common.glsl", 2, "nonsense here;");
    const Result<DrawReport> report = draw();
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().message.find("shaders/common.glsl:2: "), 0u) << report.error().message;
}

TEST_F(ShaderFolderTest, StagesThatDoNotLinkAreNamed) {
    insert("scene.frag", 1, "in vec3 never_written;\nvec3 keep() { return never_written; }");
    insert("scene.vert", 1, "out vec2 never_written;");
    const Result<DrawReport> report = draw();
    ASSERT_FALSE(report);
    EXPECT_NE(report.error().message.find("scene.vert + scene.frag"), std::string::npos)
        << report.error().message;
}

TEST_F(ShaderFolderTest, MissingShaderIsBadInputAndSaysWhatToDo) {
    fs::remove(folder_ / "scene.vert");
    const Result<DrawReport> report = draw();
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().kind, ErrorKind::BadInput);
    EXPECT_NE(report.error().message.find((folder_ / "scene.vert").string()), std::string::npos);
    EXPECT_NE(report.error().message.find("LODESTONE_SHADER_DIR"), std::string::npos);
}

} // namespace
} // namespace lodestone
