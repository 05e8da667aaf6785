// What views show beside the materials: values as colours, marks, the state of a LOD, the floor.
#include "scene/vertex_value.h"
#include "tests/render/view_fixture.h"

#include <gtest/gtest.h>

namespace lodestone {
namespace {

using namespace tests;

class DisplayTest : public ViewTest {
protected:
    // Black to white.
    void useGreyColors() {
        for (std::size_t i = 0; i < input_.options.value_colors.size(); ++i)
            input_.options.value_colors[i] = glm::vec3(static_cast<float>(i) / 8.0f);
    }

    // Like square(), with the value 0 at its left and 1 at its right edge.
    static std::shared_ptr<Geometry> valuedSquare(bool with_normals) {
        auto geometry = std::make_shared<Geometry>(*square(with_normals));
        geometry->attributes.push_back(
            floats(std::string(kVertexValueSemantic), 1, {0.0f, 1.0f, 1.0f, 0.0f}));
        return geometry;
    }
};

TEST_F(DisplayTest, ValuesAreColoursOfTheMap) {
    for (const bool with_normals : {true, false}) {
        load(sceneOf(valuedSquare(with_normals), unlit(glm::vec4(1.0f))));
        useGreyColors();
        input_.options.shading = Shading::ByValue;
        const Pixels pixels = draw();
        expectColor(at(pixels, -0.5, 0.0), {68, 68, 68, 255}); // the pixel beside -0.5
        expectColor(at(pixels, 0.5, 0.0), {195, 195, 195, 255});
        input_.options.value_full = 0.5f; // twice as bright, nothing above white
        const Pixels brighter = draw();
        expectColor(at(brighter, -0.5, 0.0), {135, 135, 135, 255});
        expectColor(at(brighter, 0.5, 0.0), {255, 255, 255, 255});
    }
}

TEST_F(DisplayTest, SurfacesWithoutValuesAreGrey) {
    load(sceneOf(square(true), unlit({1.0f, 0.0f, 0.0f, 1.0f})));
    useGreyColors();
    input_.options.shading = Shading::ByValue;
    expectColor(at(draw(), 0.0, 0.0), {82, 82, 82, 255}, 6);
}

TEST_F(DisplayTest, TexelsAreCountedAlongAWorldUnitOnALogarithmicScale) {
    Material material = unlit({0.5f, 0.5f, 0.5f, 1.0f});
    material.base_color_texture.image = 0; // 2 texels over the square's 2 units
    const auto middleOf = [&](double instance_scale, float uv_scale) {
        material.base_color_texture.uv_transform[0][0] = uv_scale;
        material.base_color_texture.uv_transform[1][1] = uv_scale;
        const auto scene = sceneOf(square(true), material);
        scene->images.push_back(pngImage(std::vector<std::uint8_t>(16, 200)));
        scene->instances[0].transform = glm::dmat4(glm::dmat3(instance_scale));
        scene->instances[0].transform[3] = glm::dvec4(0, 0, 0, 1);
        load(scene);
        useGreyColors();
        input_.options.shading = Shading::ByTexels;
        input_.options.value_full = 8.0f;
        input_.options.value_span = 64.0f;
        return int{at(draw(), 0.1, 0.2)[0]};
    };
    EXPECT_NEAR(middleOf(1.0, 1.0f), 128, 3) << "1 texel a unit: the middle of 1/8 to 8";
    EXPECT_NEAR(middleOf(1.0, 4.0f), 212, 3) << "4: two octaves of six above it";
    EXPECT_NEAR(middleOf(0.5, 1.0f), 170, 3) << "2: the same texels on half the length";
    EXPECT_NEAR(middleOf(1.0, 100.0f), 255, 3) << "above the scale";
}

TEST_F(DisplayTest, SurfacesWithoutATextureHaveNoTexels) {
    load(sceneOf(square(true), unlit({1.0f, 0.0f, 0.0f, 1.0f})));
    useGreyColors();
    input_.options.shading = Shading::ByTexels;
    expectColor(at(draw(), 0.0, 0.0), {82, 82, 82, 255}, 6);
}

TEST_F(DisplayTest, AHighlightMarksTheSubmeshOrOneInstance) {
    const auto scene = sceneOf(square(true), unlit({0.0f, 0.0f, 0.0f, 1.0f}));
    scene->instances.resize(2);
    scene->instances[0].transform[3] = glm::dvec4(-1.0, 0.0, 0.0, 1.0);
    scene->instances[1].transform[3] = glm::dvec4(1.0, 0.0, 0.0, 1.0);
    load(scene);
    input_.options.highlight_srgb = glm::vec3(0.0f, 1.0f, 0.0f);
    const auto marked = [&](double x) { return at(draw(), x, 0.3)[1] > 100; };
    EXPECT_FALSE(marked(-1.0) || marked(1.0));
    input_.options.highlighted = {{0, kNone}};
    EXPECT_TRUE(marked(-1.0) && marked(1.0));
    input_.options.highlighted = {{0, 1}};
    EXPECT_TRUE(!marked(-1.0) && marked(1.0));
    input_.options.highlighted = {{0, 7}, {5, kNone}}; // not there
    EXPECT_FALSE(marked(-1.0) || marked(1.0));
}

TEST_F(DisplayTest, AnotherScenesInstancesAreMarkedOverASurfaceThatLiesWhereTheyDo) {
    const GeometryPtr one = square(false);
    auto both = std::make_shared<Geometry>(); // two squares that are one mesh
    for (const float x : {-1.0f, 1.0f})
        for (const glm::vec3& position : one->positions)
            both->positions.push_back(position + glm::vec3(x, 0.0f, 0.0f));
    both->indices = {0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7};
    const auto instanced = sceneOf(square(true), unlit({0.0f, 0.0f, 0.0f, 1.0f}));
    instanced->instances.resize(2);
    instanced->instances[0].transform[3] = glm::dvec4(-1.0, 0.0, -0.001, 1.0); // behind it
    instanced->instances[1].transform[3] = glm::dvec4(1.0, 0.0, -0.001, 1.0);
    load(sceneOf(both, unlit({0.0f, 0.0f, 0.0f, 1.0f})));
    Result<GpuScene> marked = GpuScene::create(*renderer_, instanced);
    ASSERT_TRUE(marked) << marked.error().message;
    LodHandle lod;
    ASSERT_TRUE(marked->update(lod, fullLod(*instanced)));
    input_.marked_scene = &*marked;
    input_.marked_lod = &lod;
    input_.options.highlight_srgb = glm::vec3(0.0f, 1.0f, 0.0f);
    const auto is_marked = [&](double x) { return at(draw(), x, 0.3)[1] > 100; };
    EXPECT_FALSE(is_marked(-1.0) || is_marked(1.0));
    input_.options.highlighted = {{0, 1}};
    EXPECT_TRUE(!is_marked(-1.0) && is_marked(1.0));
    input_.options.highlighted = {{0, kNone}};
    EXPECT_TRUE(is_marked(-1.0) && is_marked(1.0));
}

TEST_F(DisplayTest, AHighlightFindsItsInstanceInALodsOrder) {
    const auto scene = sceneOf(square(true), unlit({0.0f, 0.0f, 0.0f, 1.0f}));
    scene->instances.resize(2);
    scene->instances[0].transform[3] = glm::dvec4(-1.0, 0.0, 0.0, 1.0);
    scene->instances[1].transform[3] = glm::dvec4(1.0, 0.0, 0.0, 1.0);
    load(scene);
    Lod lod = fullLod(*scene);
    lod.submeshes[0].instance_order =
        std::make_shared<const std::vector<std::uint32_t>>(std::vector<std::uint32_t>{1, 0});
    ASSERT_TRUE(gpu_->update(lod_, lod));
    input_.options.highlighted = {{0, 1}};
    EXPECT_GT(at(draw(), 1.0, 0.3)[1], 80);
    EXPECT_LT(at(draw(), -1.0, 0.3)[1], 20);
    lod.submeshes[0].kept_instances = 1;
    ASSERT_TRUE(gpu_->update(lod_, lod));
    input_.options.highlighted = {{0, 0}}; // removed: nothing to mark
    EXPECT_LT(at(draw(), 1.0, 0.3)[1], 20);
}

TEST_F(DisplayTest, TheStateOfALodIsGreyUntilTrianglesAreGone) {
    const auto scene = sceneOf(square(true), unlit(glm::vec4(1.0f)));
    load(scene);
    input_.options.shading = Shading::ByLodState;
    for (glm::vec3& color : input_.options.value_colors)
        color = {1.0f, 0.0f, 0.0f};
    const Rgba8 before = at(draw(), 0.5, -0.5);
    EXPECT_NEAR(before[0], before[1], 25);
    Lod lod = fullLod(*scene);
    auto half = std::make_shared<Geometry>(*lod.submeshes[0].primitives[0]);
    half->indices = {0, 1, 2};
    lod.submeshes[0].primitives[0] = half;
    ASSERT_TRUE(gpu_->update(lod_, lod));
    const Rgba8 after = at(draw(), 0.5, -0.5);
    EXPECT_GT(after[0], after[1] + 60);
}

TEST_F(DisplayTest, TheGridLiesUnderTheSceneAndBehindIt) {
    load(sceneOf(square(true), unlit({1.0f, 0.0f, 0.0f, 1.0f})));
    input_.camera.orthographic = false;
    input_.camera.elevation_rad = 0.3;
    const Pixels without = draw();
    input_.options.grid = true;
    const Pixels with = draw();
    std::size_t lines = 0;
    for (std::uint32_t y = 0; y < with.height; ++y)
        for (std::uint32_t x = 0; x < with.width; ++x) {
            const bool on_square = without.at(x, y)[0] > 200;
            const bool differs = with.at(x, y) != without.at(x, y);
            EXPECT_FALSE(on_square && differs && y < with.height / 2) << x << ", " << y;
            lines += differs && !on_square ? 1 : 0;
        }
    EXPECT_GT(lines, 50u);
}

TEST_F(DisplayTest, ShininessNarrowsTheGloss) {
    Material rough;
    rough.base_color = {0.1f, 0.1f, 0.1f, 1.0f};
    rough.metallic = 0.0f;
    rough.roughness = 0.9f;
    load(sceneOf(square(true), rough));
    input_.options.light_azimuth_rad = 0.0f;
    input_.options.light_elevation_rad = 0.0f;
    const int matt = at(draw(), 0.0, 0.0)[0];
    input_.options.shininess = 4.0f;
    EXPECT_GT(at(draw(), 0.0, 0.0)[0], matt + 20);
}

TEST_F(DisplayTest, InstancesOutsideTheViewAreNotDrawnAndNoneInsideIsMissing) {
    const auto scene = sceneOf(square(true), unlit({1.0f, 0.0f, 0.0f, 1.0f}));
    scene->instances.resize(100); // in a row, 3 apart
    for (std::size_t i = 0; i < scene->instances.size(); ++i)
        scene->instances[i].transform[3] = glm::dvec4(3.0 * static_cast<double>(i), 0.0, 0.0, 1.0);
    load(scene);
    input_.camera.scene_radius = 200.0;
    input_.camera.target = {150.0, 0.0, 0.0}; // the 50th
    for (const bool orthographic : {true, false}) {
        input_.camera.orthographic = orthographic;
        expectColor(at(draw(), 0.0, 0.0), {255, 0, 0, 255});
        EXPECT_GE(report_.triangles, 2u);
        EXPECT_LE(report_.triangles, 2u * 5);
        expectColor(at(draw(), 1.8, 0.0), {0, 0, 0, 255});
    }
    input_.camera.target = {151.8, 0.0, 0.0}; // two of them at the edges
    const Pixels edges = draw();
    expectColor(at(edges, -1.7, 0.0), {255, 0, 0, 255});
    expectColor(at(edges, 1.7, 0.0), {255, 0, 0, 255});
    input_.camera.target = {150.0, 80.0, 0.0};
    EXPECT_LT(litShare(draw()), 0.001);
    EXPECT_EQ(report_.triangles, 0u);
    input_.camera.target = {150.0, 0.0, 0.0};
    input_.camera.distance *= 100.0;
    draw();
    EXPECT_EQ(report_.triangles, 200u);
}

TEST_F(DisplayTest, EveryShadingDrawsTheSurface) {
    for (int shading = 0; shading <= static_cast<int>(Shading::ByValue); ++shading) {
        load(sceneOf(valuedSquare(true), unlit(glm::vec4(1.0f))));
        input_.options.value_colors.fill(glm::vec3(1.0f));
        input_.options.shading = static_cast<Shading>(shading);
        EXPECT_GT(litShare(draw()), 0.2) << shading;
        input_.options.wireframe = true;
        EXPECT_GT(litShare(draw()), 0.2) << shading << " with edges";
    }
}

} // namespace
} // namespace lodestone
