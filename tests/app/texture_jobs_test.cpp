#include "app/scene_texels.h"
#include "app/session.h"
#include "app/texture_jobs.h"
#include "scene/scene_builder.h"
#include "tests/png_image.h"
#include "tests/simplify/meshes.h"

#include <gtest/gtest.h>
#include <unistd.h>

namespace lodestone {

namespace {

constexpr double kPatience_s = 60.0;

Image checks(int width) {
    constexpr int kHeight = 32;
    std::vector<std::uint8_t> rgb;
    for (int at = 0; at < width * kHeight; ++at) {
        const bool dark = (at / 4 + at / width / 4) % 2 == 0;
        rgb.insert(rgb.end(), {static_cast<std::uint8_t>(dark ? 200 : 40), 90, 60});
    }
    return pngImage("checks", width, kHeight, rgb);
}

ScenePtr checkedSphere(int image_width) {
    const GeometryPtr round = meshes::sphere(60, 64);
    std::vector<float> uv;
    for (const glm::vec3& p : round->positions)
        uv.insert(uv.end(), {0.5f + 0.4f * p.x, 0.5f + 0.4f * p.y});
    SceneBuilder builder("checked");
    Material material;
    material.base_color_texture.image = builder.addImage(checks(image_width));
    Primitive primitive;
    primitive.material = builder.addMaterial(material);
    primitive.geometry = meshes::withAttribute(*round, "TEXCOORD_0", uv);
    builder.addNode("one", kNone, Trs{}, builder.addSubmesh({"sphere", {primitive}}));
    return builder.finish();
}

class TextureJobsTest : public ::testing::Test {
protected:
    TextureJobsTest()
        : folder(std::filesystem::temp_directory_path() /
                 ("lodestone_textures_" + std::to_string(getpid()))),
          session(Session::Options{}) {
        std::filesystem::create_directories(folder);
        open(*checkedSphere(32));
    }

    ~TextureJobsTest() override { std::filesystem::remove_all(folder); }

    void send(Command command) {
        CommandQueue queue;
        queue.push(std::move(command));
        session.update(queue);
    }

    void open(const Scene& scene) {
        EXPECT_TRUE(exportScene(scene, fullLod(scene), folder / "checked.glb", {}));
        send(OpenScene{folder / "checked.glb"});
        finish();
        set("atlas", 256.0); // small and quick
    }

    void finish() { ASSERT_TRUE(session.updateUntilIdle(kPatience_s)); }

    void set(const char* parameter, double value) {
        send(SetLaneParameter{lane().id, parameter, value});
    }

    const Lane& lane() const { return session.document().lanes[1]; } // IAS

    bool transfers() const {
        const auto& jobs = session.document().jobs;
        return std::ranges::find(jobs, JobKind::Texture, &JobStatus::kind) != jobs.end();
    }

    std::filesystem::path folder;
    Session session;
};

} // namespace

TEST_F(TextureJobsTest, ALaneDrawsItsOwnTexturesOnTheSameLevelAndKeepsThemAgain) {
    const LaneStatus before = lane().status;
    set("texture", 1.0);
    EXPECT_TRUE(transfers());
    EXPECT_EQ(lane().status.state, LaneState::Ready);
    EXPECT_EQ(drawnLod(lane().status).scene, before.scene); // the last good picture
    finish();
    const LaneStatus& status = lane().status;
    EXPECT_EQ(status.lod, before.lod); // its sequence was not built again
    ASSERT_TRUE(status.textures);
    EXPECT_EQ(drawnLod(status).scene, status.textures->baked.scene);
    EXPECT_EQ(drawnLod(status).lod->triangles, before.numbers.triangles);
    ASSERT_EQ(status.textures->previews.size(), 1u);
    EXPECT_EQ(status.textures->previews[0].before_px, 32u);
    EXPECT_EQ(status.textures->previews[0].after_px, 256u);
    EXPECT_GT(status.textures->previews[0].original_texels_per_unit, 0.0);
    set("texture", 0.0);
    EXPECT_FALSE(lane().status.textures);
    EXPECT_EQ(drawnLod(lane().status).scene, before.scene);
    EXPECT_EQ(lane().status.numbers.predicted_bytes, before.numbers.predicted_bytes);
}

TEST_F(TextureJobsTest, ASizeIsEstimatedUntilTheTexturesAreThereThenThatOfTheFile) {
    set("texture", 1.0);
    EXPECT_TRUE(lane().status.numbers.bytes_estimated);
    EXPECT_GT(lane().status.numbers.predicted_bytes, lane().status.numbers.kept_bytes);
    const ExportOptions& options = session.document().export_options;
    EXPECT_TRUE(session.predictedSize(lane().id, options).estimated);
    finish();
    EXPECT_FALSE(lane().status.numbers.bytes_estimated);
    EXPECT_FALSE(session.predictedSize(lane().id, options).estimated);
    EXPECT_EQ(session.predictedSize(lane().id, options).bytes,
              lane().status.numbers.predicted_bytes);
    send(Export{lane().id, folder / "written.glb"});
    finish();
    EXPECT_EQ(std::filesystem::file_size(folder / "written.glb"),
              lane().status.numbers.predicted_bytes);
}

TEST_F(TextureJobsTest, AnExportThatComesFirstTransfersThemItself) {
    set("texture", 1.0);
    send(Export{lane().id, folder / "early.glb"});
    finish();
    EXPECT_EQ(std::filesystem::file_size(folder / "early.glb"),
              lane().status.numbers.predicted_bytes);
}

TEST_F(TextureJobsTest, AnExportThatTransfersCanBeCancelledAndLeavesTheOldFile) {
    const std::filesystem::path path = folder / "old.glb";
    send(Export{lane().id, path});
    finish();
    const auto bytes_before = std::filesystem::file_size(path);
    set("texture", 1.0);
    set("atlas", 2048.0); // not done before the next line
    send(Export{lane().id, path});
    send(CancelJob{0});
    EXPECT_TRUE(session.document().jobs.empty());
    finish();
    EXPECT_EQ(std::filesystem::file_size(path), bytes_before);
    const auto& messages = session.document().messages;
    EXPECT_TRUE(std::ranges::any_of(messages, [](const Message& message) {
        return message.text == "Writing old.glb: cancelled";
    }));
    const auto files = std::distance(std::filesystem::directory_iterator(folder), {});
    EXPECT_EQ(files, 2) << "the model and the old file";
}

TEST_F(TextureJobsTest, PreviewsAreHalvedUntilTheyAreSmall) {
    open(*checkedSphere(1030));
    set("texture", 1.0);
    finish();
    ASSERT_TRUE(lane().status.textures);
    const AtlasPreview& preview = lane().status.textures->previews[0];
    EXPECT_EQ(preview.before_px, 1030u);
    EXPECT_EQ(preview.before.width, 515u);
    EXPECT_EQ(preview.before.height, 16u);
    EXPECT_EQ(preview.before.rgba.size(), 4u * 515 * 16);
    EXPECT_EQ(preview.before.rgba[1], 90) << "green is the same everywhere";
    EXPECT_EQ(preview.after.width, preview.after_px) << "small enough as it is";
}

TEST_F(TextureJobsTest, TexelsOfTheSceneAreTheMeanOverItsInstances) {
    EXPECT_GT(session.document().texels_per_unit, 0.0);
    const ScenePtr one = checkedSphere(32);
    auto two = std::make_shared<Scene>(*one);
    two->instances.push_back(two->instances[0]);
    two->instances[1].transform = glm::dmat4(glm::dmat3(3.0)); // nine times the area
    EXPECT_NEAR(texelsPerUnit(*two), texelsPerUnit(*one) * std::sqrt(2.0 / 10.0), 1e-9);
    two->materials[0].base_color_texture.image = kNone;
    EXPECT_EQ(texelsPerUnit(*two), 0.0);
}

TEST_F(TextureJobsTest, WhileATargetIsDraggedNothingIsTransferredAfterwardsTheNewestIs) {
    set("texture", 1.0);
    finish();
    const LaneTexturesPtr first = lane().status.textures;
    constexpr DragKey kDrag = 7;
    for (const double ratio : {0.3, 0.4, 0.5}) {
        send(SetLaneTarget{lane().id, {Target::Kind::Ratio, ratio}, kDrag});
        EXPECT_FALSE(transfers());
        EXPECT_EQ(drawnLod(lane().status).lod, lane().status.lod); // it follows at once
    }
    send(EndDrag{});
    EXPECT_TRUE(transfers());
    EXPECT_EQ(lane().status.textures, first);
    send(SetLaneTarget{lane().id, {Target::Kind::Ratio, 0.1}, 0}); // in place of the one that runs
    finish();
    EXPECT_EQ(lane().status.textures->lod_revision, lane().status.lod_revision);
    EXPECT_EQ(lane().status.textures->lod->triangles, lane().status.numbers.triangles);
}

TEST_F(TextureJobsTest, AnAtlasThatIsTooSmallIsToldAndTheLevelStays) {
    send(SetLaneTarget{lane().id, {Target::Kind::Ratio, 1.0}, 0});
    set("texture", 1.0);
    finish();
    EXPECT_FALSE(lane().status.textures);
    EXPECT_NE(lane().status.texture_failure.find("too small"), std::string::npos)
        << lane().status.texture_failure;
    EXPECT_EQ(drawnLod(lane().status).lod, lane().status.lod);
    EXPECT_FALSE(transfers());
    set("atlas", 512.0);
    finish();
    EXPECT_TRUE(lane().status.textures);
    EXPECT_TRUE(lane().status.texture_failure.empty());
}

TEST_F(TextureJobsTest, ACancelledTransferWaitsUntilItIsAskedForAgain) {
    set("texture", 1.0);
    ASSERT_TRUE(transfers());
    send(CancelJob{0});
    EXPECT_FALSE(transfers());
    finish();
    EXPECT_FALSE(lane().status.textures);
    send(RetryLane{lane().id});
    finish();
    EXPECT_TRUE(lane().status.textures);
}

} // namespace lodestone
