#include "render/pick.h"
#include "render/view.h"
#include "tests/render/view_fixture.h"

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <gtest/gtest.h>
#include <optional>
#include <stb_image_write.h>

namespace lodestone {
namespace {

using namespace tests;

TEST_F(ViewTest, SquareCoversAQuarterInItsOwnColour) {
    load(sceneOf(square(true), unlit({1.0f, 0.2140f, 0.0f, 1.0f})));
    const Pixels pixels = draw();
    expectColor(at(pixels, 0.0, 0.0), {255, 128, 0, 255});
    expectColor(at(pixels, 1.5, 0.0), {0, 0, 0, 255});
    EXPECT_NEAR(litShare(pixels), 0.25, 0.02);
    EXPECT_EQ(report_.draw_calls, 1u);
    EXPECT_EQ(report_.triangles, 2u);
}

TEST_F(ViewTest, TextureIsTheRightWayUp) {
    Material material = unlit(glm::vec4(1.0f));
    material.base_color_texture.image = 0;
    material.base_color_texture.nearest = true;
    const auto scene = sceneOf(square(true), material);
    scene->images.push_back(
        pngImage({255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 255}));
    load(scene);
    const Pixels pixels = draw();
    expectColor(at(pixels, -0.5, 0.5), {255, 0, 0, 255});
    expectColor(at(pixels, 0.5, 0.5), {0, 255, 0, 255});
    expectColor(at(pixels, -0.5, -0.5), {0, 0, 255, 255});
    expectColor(at(pixels, 0.5, -0.5), {255, 255, 255, 255});
}

TEST_F(ViewTest, AlphaMaskCutsAndBlendMixes) {
    Material material = unlit(glm::vec4(1.0f));
    material.base_color_texture.image = 0;
    material.base_color_texture.nearest = true;
    material.alpha_mode = AlphaMode::Mask;
    const auto scene = sceneOf(square(true), material);
    scene->images.push_back(
        pngImage({255, 255, 255, 255, 255, 255, 255, 0, 255, 255, 255, 0, 255, 255, 255, 255}));
    load(scene);
    for (const int samples : {1, 4}) {
        input_.options.samples = samples;
        const Pixels cut = draw();
        expectColor(at(cut, -0.5, 0.5), {255, 255, 255, 255});
        expectColor(at(cut, 0.5, 0.5), {0, 0, 0, 255});
    }
    Material glass = unlit({1.0f, 1.0f, 1.0f, 0.5f});
    glass.alpha_mode = AlphaMode::Blend;
    load(sceneOf(square(true), glass));
    expectColor(at(draw(), 0.0, 0.0), {128, 128, 128, 255});
}

TEST_F(ViewTest, TransparentInstancesAreDrawnBackToFront) {
    Material red = unlit({1.0f, 0.0f, 0.0f, 0.5f});
    red.alpha_mode = AlphaMode::Blend;
    red.double_sided = true;
    const auto scene = sceneOf(square(true), red);
    scene->materials.push_back(red);
    scene->materials[1].base_color = {0.0f, 1.0f, 0.0f, 0.5f};
    scene->submeshes.push_back(scene->submeshes[0]);
    scene->submeshes[1].primitives[0].material = 1;
    scene->instances.resize(3); // red nearest and farthest, green between
    scene->instances[2].submesh = 1;
    for (int i = 0; i < 3; ++i)
        scene->instances[static_cast<std::size_t>(i)].transform[3].z = i == 2 ? 0.0 : 1.0 - 2.0 * i;
    load(scene);
    for (const AxisView side : {AxisView::Front, AxisView::Back}) {
        setAxisView(input_.camera, side);
        expectColor(at(draw(), 0.0, 0.0), {159, 64, 0, 255}); // 1/8 + 1/2 red, 1/4 green
        EXPECT_EQ(report_.draw_calls, 3u);
        EXPECT_EQ(report_.triangles, 6u);
    }
    input_.options.shading = Shading::Clay; // opaque: one call each
    draw();
    EXPECT_EQ(report_.draw_calls, 2u);
}

TEST_F(ViewTest, MirroredInstancesKeepFacingAndCulling) {
    const auto scene = sceneOf(square(true), unlit(glm::vec4(1.0f)));
    scene->instances[0].transform[0][0] = -1.0;
    load(scene); // all mirrored
    EXPECT_NEAR(litShare(draw()), 0.25, 0.02);

    scene->instances.emplace_back();
    scene->instances[0].transform[3] = glm::dvec4(-1.0, 0.0, 0.0, 1.0);
    scene->instances[1].transform[3] = glm::dvec4(1.0, 0.0, 0.0, 1.0);
    load(scene); // both hands in one call
    EXPECT_NEAR(litShare(draw()), 0.5, 0.03);
    EXPECT_EQ(report_.draw_calls, 1u);

    setAxisView(input_.camera, AxisView::Back); // single-sided: nothing from behind
    EXPECT_EQ(litShare(draw()), 0.0);
    input_.options.back_faces = BackFaces::Shown;
    EXPECT_NEAR(litShare(draw()), 0.5, 0.03);
}

TEST_F(ViewTest, NormalsAreRightUnderShearMirrorAndScale) {
    // The square's plane z = 0 becomes z = -x / 2: its normal is (1, 0, 2) / sqrt(5).
    for (const double mirror : {1.0, -1.0}) {
        const auto scene = sceneOf(square(true), Material{});
        glm::dmat4& transform = scene->instances[0].transform;
        transform[0] = glm::dvec4(mirror, 0.0, -0.5 * mirror, 0.0);
        transform[1] = glm::dvec4(0.7, 3.0, -0.35, 0.0); // shear in the plane, stretched
        transform[2] = glm::dvec4(0.0, 0.0, 0.01, 0.0);
        load(scene);
        input_.options.shading = Shading::Normals;
        const double root = std::sqrt(5.0);
        expectColor(at(draw(), 0.0, 0.0),
                    {static_cast<std::uint8_t>(std::lround(127.5 * (1.0 / root + 1.0))),
                     128,
                     static_cast<std::uint8_t>(std::lround(127.5 * (2.0 / root + 1.0))),
                     255});
    }
}

TEST_F(ViewTest, MissingNormalsAreShadedByTheFace) {
    load(sceneOf(square(false), Material{}));
    input_.options.shading = Shading::Normals;
    expectColor(at(draw(), 0.0, 0.0), {128, 128, 255, 255});
}

TEST_F(ViewTest, EveryShadingShowsTheModelAndWireframeChangesIt) {
    load(sceneOf(square(true), Material{}));
    for (int shading = 0; shading <= int(Shading::ByInstance); ++shading) {
        input_.options.shading = Shading(shading);
        input_.options.wireframe = false;
        const Pixels plain = draw();
        EXPECT_NEAR(litShare(plain), 0.25, 0.02) << "shading " << shading;
        input_.options.wireframe = true;
        const Pixels wired = draw();
        EXPECT_NE(plain.rgba, wired.rgba) << "shading " << shading;
        EXPECT_EQ(at(plain, 0.5, -0.25), at(wired, 0.5, -0.25)) << "shading " << shading;
    }
}

TEST_F(ViewTest, UnchangedViewIsNotRedrawn) {
    load(sceneOf(square(true), Material{}));
    draw();
    EXPECT_TRUE(report_.drew);
    EXPECT_TRUE(report_.cost_known || !renderer_->info().is_software);
    draw();
    EXPECT_FALSE(report_.drew);
    orbitCamera(input_.camera, 0.1, 0.0);
    draw();
    EXPECT_TRUE(report_.drew);
    const Result<UploadReport> same = gpu_->update(lod_, fullLod(*gpu_->scene()));
    ASSERT_TRUE(same);
    EXPECT_EQ(same->bytes, 0u);
    draw();
    EXPECT_FALSE(report_.drew);
    gpu_->setHiddenSubmeshes({true});
    EXPECT_EQ(litShare(draw()), 0.0);
    EXPECT_TRUE(report_.drew);
}

TEST_F(ViewTest, LodsShareGeometryAndFreeWhatNoneUses) {
    const auto scene = sceneOf(square(true), unlit(glm::vec4(1.0f)));
    scene->instances.emplace_back();
    scene->instances[1].transform[3] = glm::dvec4(1.0, 1.0, 0.0, 1.0);
    load(scene);
    const std::uint64_t before = gpu_->memoryBytes();
    LodHandle other;
    ASSERT_EQ(gpu_->update(other, fullLod(*scene))->bytes, 0u);
    EXPECT_NE(other.revision(), lod_.revision());

    Lod smaller = fullLod(*scene);
    auto triangle = std::make_shared<Geometry>(*smaller.submeshes[0].primitives[0]);
    triangle->indices = {0, 1, 2};
    smaller.submeshes[0].primitives[0] = triangle;
    smaller.submeshes[0].instance_order =
        std::make_shared<const std::vector<std::uint32_t>>(std::vector<std::uint32_t>{1, 0});
    smaller.submeshes[0].kept_instances = 1;
    const Result<UploadReport> changed = gpu_->update(other, smaller);
    ASSERT_TRUE(changed);
    EXPECT_EQ(changed->geometries, 1u);
    EXPECT_EQ(changed->instance_buffers, 1u);
    EXPECT_EQ(other.triangles(), 1u);
    EXPECT_GT(gpu_->memoryBytes(), before);
    input_.lod = &other;
    EXPECT_NEAR(litShare(draw()), 0.125, 0.02); // half a square, one of two instances
    other = LodHandle();
    EXPECT_EQ(gpu_->memoryBytes(), before);
}

TEST_F(ViewTest, FarFromTheOriginStaysSharp) {
    const auto scene = sceneOf(square(true), unlit(glm::vec4(1.0f)));
    scene->instances[0].transform[3] = glm::dvec4(3e8, -7e8, 5e8, 1.0);
    load(scene);
    EXPECT_NEAR(litShare(draw()), 0.25, 0.02);
}

TEST_F(ViewTest, EmptyAndOddScenesDrawTheBackground) {
    load(std::make_shared<Scene>());
    EXPECT_EQ(litShare(draw()), 0.0);
    auto collapsed = std::make_shared<Geometry>();
    const auto scene = sceneOf(collapsed, Material{});
    load(scene);
    EXPECT_EQ(litShare(draw()), 0.0);
    EXPECT_EQ(report_.draw_calls, 0u);
    input_.scene = nullptr;
    input_.options.background_srgb = glm::vec3(1.0f);
    EXPECT_EQ(litShare(draw()), 1.0);
    input_.size = {0, 10};
    EXPECT_FALSE(view_->draw(input_));
}

TEST_F(ViewTest, TransparentBackgroundHasStraightAlpha) {
    load(sceneOf(square(true), unlit(glm::vec4(1.0f))));
    input_.options.background = Background::Transparent;
    const Pixels pixels = draw();
    EXPECT_EQ(at(pixels, 1.5, 1.5)[3], 0);
    expectColor(at(pixels, 0.0, 0.0), {255, 255, 255, 255});
}

TEST_F(ViewTest, UndecodableImageIsNotedAndDrawnNeutral) {
    Material material = unlit(glm::vec4(1.0f));
    material.base_color_texture.image = 0;
    const auto scene = sceneOf(square(true), material);
    Image image;
    image.mime_type = "image/ktx2";
    image.bytes = std::make_shared<std::vector<std::byte>>(100);
    scene->images.push_back(image);
    load(scene);
    ASSERT_EQ(gpu_->notes().size(), 1u);
    EXPECT_NE(gpu_->notes()[0].find("image/ktx2"), std::string::npos);
    expectColor(at(draw(), 0.0, 0.0), {255, 255, 255, 255});
}

TEST_F(ViewTest, MeasuringCountsTheFramesAskedFor) {
    load(sceneOf(square(true), Material{}));
    MeasureOptions options;
    options.warmup_frames = 1;
    options.frames = 3;
    const Result<MeasureReport> report = view_->measure(input_, options);
    ASSERT_TRUE(report);
    EXPECT_EQ(report->frames, 3u);
    EXPECT_GT(report->mean_ms, 0.0);
}

TEST_F(ViewTest, PickFindsTheInstanceThatIsSeen) {
    // Three squares: left; right, mirrored; in front of the right one a small one.
    const auto scene = sceneOf(square(true), unlit(glm::vec4(1.0f)));
    scene->instances.resize(3);
    scene->instances[0].transform[3] = glm::dvec4(-1.0, 0.0, 0.0, 1.0);
    scene->instances[1].transform[3] = glm::dvec4(1.0, 0.0, 0.0, 1.0);
    scene->instances[1].transform[0][0] = -1.0;
    scene->instances[2].transform[3] = glm::dvec4(1.0, 0.0, 0.5, 1.0);
    scene->instances[2].transform[0][0] = 0.25;
    scene->instances[2].transform[1][1] = 0.25;
    load(scene);
    for (const bool orthographic : {true, false}) {
        input_.camera.orthographic = orthographic;
        const auto picked_at = [&](double x, double y) { // x, y: -2..2, y up
            return pick(input_, {(x + 2.0) / 4.0, (2.0 - y) / 4.0});
        };
        ASSERT_TRUE(picked_at(-1.0, 0.5));
        EXPECT_EQ(picked_at(-1.0, 0.5)->instance, 0u);
        EXPECT_EQ(picked_at(1.0, 0.5)->instance, 1u);
        EXPECT_EQ(picked_at(1.0, 0.02)->instance, 2u);
        EXPECT_NEAR(picked_at(-1.0, 0.5)->point.z, 0.0, 1e-9);
        EXPECT_NEAR(picked_at(-1.0, 0.5)->point.x, -1.0, 0.05);
        EXPECT_FALSE(picked_at(0.0, 1.5));
    }
    const glm::dvec2 left(0.25, 0.4);
    setAxisView(input_.camera, AxisView::Back);
    EXPECT_FALSE(pick(input_, left));
    input_.options.back_faces = BackFaces::Shown;
    EXPECT_EQ(pick(input_, left)->instance, 1u);
    gpu_->setHiddenSubmeshes({true});
    EXPECT_FALSE(pick(input_, left));
}

TEST_F(ViewTest, PickSeesTheLodThatIsDrawn) {
    const auto scene = sceneOf(square(true), unlit(glm::vec4(1.0f)));
    scene->instances.resize(2);
    load(scene);
    const glm::dvec2 lower_right(0.6, 0.7);
    const glm::dvec2 upper_left(0.4, 0.3);
    EXPECT_EQ(pick(input_, upper_left)->instance, 0u); // the first of two at the same place
    Lod lod = fullLod(*scene);
    auto triangle = std::make_shared<Geometry>(*lod.submeshes[0].primitives[0]);
    triangle->indices = {0, 1, 2};
    lod.submeshes[0].primitives[0] = triangle;
    lod.submeshes[0].instance_order =
        std::make_shared<const std::vector<std::uint32_t>>(std::vector<std::uint32_t>{1, 0});
    lod.submeshes[0].kept_instances = 1;
    ASSERT_TRUE(gpu_->update(lod_, lod));
    EXPECT_FALSE(pick(input_, upper_left));
    EXPECT_EQ(pick(input_, lower_right)->instance, 1u);
}

} // namespace
} // namespace lodestone
