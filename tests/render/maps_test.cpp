#include "tests/render/view_fixture.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <numbers>

namespace lodestone {
namespace {

using namespace tests;

using Rgba = std::array<std::uint8_t, 4>;

Image plainImage(const Rgba& color) {
    std::vector<std::uint8_t> pixels;
    for (int i = 0; i < 4; ++i)
        pixels.insert(pixels.end(), color.begin(), color.end());
    return pngImage(pixels);
}

GeometryPtr squareWith(const Attribute& attribute) {
    auto geometry = std::make_shared<Geometry>(*square(true));
    geometry->attributes.push_back(attribute);
    return geometry;
}

GeometryPtr squareWithTangents() {
    return squareWith(floats("TANGENT", 4, {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}));
}

Material rough() {
    Material material;
    material.base_color = {0.5f, 0.5f, 0.5f, 1.0f};
    material.metallic = 0.0f;
    material.double_sided = true;
    return material;
}

class MapsTest : public ViewTest {
protected:
    // The middle of a square whose normal map says the same everywhere, green as seen.
    int shade(const GeometryPtr& geometry, const Rgba& normal, const glm::dmat4& transform) {
        Material material = rough();
        material.normal_texture.image = 0;
        const auto scene = sceneOf(geometry, material);
        scene->images.push_back(plainImage(normal));
        scene->instances[0].transform = transform;
        load(scene);
        return at(draw(), 0.3, -0.3)[1];
    }

    int shade(const Material& material, const Rgba& picture) {
        const auto scene = sceneOf(square(true), material);
        scene->images.push_back(plainImage(picture));
        load(scene);
        return at(draw(), 0.3, -0.3)[1];
    }
};

constexpr Rgba kLeft{36, 128, 217, 255}; // towards -u; the key light comes from the upper left
constexpr Rgba kRight{220, 128, 217, 255};
constexpr Rgba kUp{128, 220, 217, 255}; // green points up in the picture
constexpr Rgba kDown{128, 36, 217, 255};

TEST_F(MapsTest, NormalMapsTurnTheShadingTowardsAndFromTheLight) {
    for (const GeometryPtr& geometry : {square(true), squareWithTangents()}) {
        const glm::dmat4 plain(1.0);
        EXPECT_GT(shade(geometry, kLeft, plain), shade(geometry, kRight, plain) + 20);
        EXPECT_GT(shade(geometry, kUp, plain), shade(geometry, kDown, plain) + 20);
    }
}

TEST_F(MapsTest, TangentsOfTheFileAndTangentsFromTheScreenAgree) {
    const glm::dmat4 mirrored = glm::scale(glm::dmat4(1.0), glm::dvec3(-1.0, 1.0, 1.0));
    const glm::dmat4 turned = glm::rotate(glm::dmat4(1.0), 2.5, glm::dvec3(0.1, 0.2, 1.0));
    const glm::dmat4 behind =
        glm::rotate(glm::dmat4(1.0), std::numbers::pi, glm::dvec3(0.0, 1.0, 0.0));
    for (const glm::dmat4& transform : {glm::dmat4(1.0), mirrored, turned, behind})
        for (const Rgba& normal : {kLeft, kRight, kUp, kDown})
            EXPECT_NEAR(shade(square(true), normal, transform),
                        shade(squareWithTangents(), normal, transform),
                        2);
}

TEST_F(MapsTest, TheSignOfATangentTurnsTheBitangent) {
    const GeometryPtr flipped =
        squareWith(floats("TANGENT", 4, {1, 0, 0, -1, 1, 0, 0, -1, 1, 0, 0, -1, 1, 0, 0, -1}));
    const glm::dmat4 plain(1.0);
    EXPECT_GT(shade(flipped, kDown, plain), shade(flipped, kUp, plain) + 20);
}

TEST_F(MapsTest, EmissiveGlowsWhateverTheLight) {
    Material material = rough();
    material.base_color = {0.0f, 0.0f, 0.0f, 1.0f};
    material.emissive = {0.0f, 0.4f, 0.0f};
    const int lit = shade(material, {255, 255, 255, 255});
    EXPECT_GT(lit, 150);
    input_.options.light_azimuth_rad = static_cast<float>(std::numbers::pi);
    EXPECT_NEAR(at(draw(), 0.3, -0.3)[1], lit, 12); // but for a black surface's faint gloss
    material.emissive_texture.image = 0;
    EXPECT_LT(shade(material, {255, 0, 255, 255}), lit - 80);
}

TEST_F(MapsTest, OcclusionDarkensByItsStrength) {
    Material material = rough();
    const int open = shade(material, {255, 255, 255, 255});
    material.occlusion_texture.image = 0;
    const int closed = shade(material, {0, 0, 0, 255});
    material.occlusion_strength = 0.5f;
    const int half = shade(material, {0, 0, 0, 255});
    EXPECT_LT(closed, half - 5);
    EXPECT_LT(half, open - 5);
    EXPECT_GT(closed, 20); // light that comes straight is not occluded
}

TEST_F(MapsTest, MetalAndRoughnessComeFromBlueAndGreen) {
    Material material = rough();
    material.metallic = 1.0f;
    material.metallic_roughness_texture.image = 0;
    const int metal = shade(material, {0, 255, 255, 255});
    const int dielectric = shade(material, {0, 255, 0, 255});
    EXPECT_GT(dielectric, metal + 10);
    EXPECT_NE(shade(material, {0, 40, 255, 255}), metal);
}

TEST_F(MapsTest, VertexColoursTintTheBaseColour) {
    Material material = unlit(glm::vec4(1.0f));
    const GeometryPtr tinted =
        squareWith(floats("COLOR_0", 4, {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}));
    load(sceneOf(tinted, material));
    expectColor(at(draw(), 0.3, -0.3), {255, 0, 0, 255});
}

TEST_F(MapsTest, TextureTransformsMoveThePicture) {
    Material material = unlit(glm::vec4(1.0f));
    material.base_color_texture.image = 0;
    material.base_color_texture.nearest = true;
    material.base_color_texture.uv_transform[2] = {0.5f, 0.0f, 1.0f};
    const auto scene = sceneOf(square(true), material);
    scene->images.push_back(
        pngImage({255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 255}));
    load(scene);
    const Pixels pixels = draw();
    expectColor(at(pixels, -0.5, 0.5), {0, 255, 0, 255});
    expectColor(at(pixels, 0.5, 0.5), {255, 0, 0, 255});
}

} // namespace
} // namespace lodestone
