#include "app/cli_run.h"
#include "scene/scene_builder.h"
#include "tests/png_image.h"
#include "tests/simplify/meshes.h"

#include <gtest/gtest.h>
#include <random>
#include <unistd.h>

namespace lodestone {

namespace {

// Nothing that PNG could make small.
Image noise() {
    constexpr int kSide = 64;
    std::mt19937 random(5);
    std::vector<std::uint8_t> rgb(std::size_t{3} * kSide * kSide);
    for (std::uint8_t& value : rgb)
        value = static_cast<std::uint8_t>(random() & 0xffu);
    return pngImage("noise", kSide, kSide, rgb);
}

ScenePtr noisySphere() {
    const GeometryPtr round = meshes::sphere(30, 32);
    std::vector<float> uv;
    for (const glm::vec3& p : round->positions)
        uv.insert(uv.end(), {0.5f + 0.4f * p.x, 0.5f + 0.4f * p.y});
    SceneBuilder builder("noisy");
    Material material;
    material.base_color_texture.image = builder.addImage(noise());
    Primitive primitive;
    primitive.material = builder.addMaterial(material);
    primitive.geometry = meshes::withAttribute(*round, "TEXCOORD_0", uv);
    builder.addNode("one", kNone, Trs{}, builder.addSubmesh({"sphere", {primitive}}));
    return builder.finish();
}

RunOutcome runWithin(double size_bytes) {
    RunRequest request;
    request.scene = noisySphere();
    request.algorithm = findAlgorithm("wild");
    request.parameters = {{"texture", 1.0}, {"atlas", 512.0}};
    request.target = {Target::Kind::Bytes, size_bytes};
    Result<RunOutcome> outcome = runAlgorithm(request, {});
    EXPECT_TRUE(outcome) << outcome.error().message;
    return outcome ? std::move(*outcome) : RunOutcome{};
}

// As written.
std::uint64_t fileSize(const RunOutcome& outcome) {
    const std::filesystem::path path =
        std::filesystem::temp_directory_path() /
        ("lodestone_transfer_size_" + std::to_string(getpid()) + ".glb");
    EXPECT_TRUE(exportScene(*outcome.scene, *outcome.lod, path, {}));
    const std::uint64_t size = std::filesystem::file_size(path);
    std::filesystem::remove(path);
    return size;
}

} // namespace

TEST(TransferSize, FilesWithNewTexturesAreNoLargerThanAsked) {
    for (const double size : {350'000.0, 600'000.0}) {
        const RunOutcome outcome = runWithin(size);
        ASSERT_TRUE(outcome.scene);
        EXPECT_TRUE(outcome.target_met) << size;
        EXPECT_EQ(outcome.bytes, fileSize(outcome));
        EXPECT_LE(static_cast<double>(outcome.bytes), size);
        EXPECT_GT(static_cast<double>(outcome.bytes), 0.5 * size); // room is made use of
    }
}

TEST(TransferSize, AtlasesShrinkWhereNoLevelIsSmallEnough) {
    const RunOutcome outcome = runWithin(150'000.0); // about a third of an atlas of 512 pixels
    ASSERT_TRUE(outcome.scene);
    EXPECT_TRUE(outcome.target_met);
    EXPECT_EQ(outcome.bytes, fileSize(outcome));
    EXPECT_LE(outcome.bytes, 150'000u);
}

TEST(TransferSize, ASizeThatNoAtlasFitsIsToldToBeMissed) {
    const RunOutcome outcome = runWithin(5'000.0);
    ASSERT_TRUE(outcome.scene);
    EXPECT_FALSE(outcome.target_met);
    EXPECT_GT(outcome.bytes, 5'000u);
    ASSERT_FALSE(outcome.notes.empty());
    EXPECT_NE(outcome.notes.back().find("no room"), std::string::npos);
}

} // namespace lodestone
