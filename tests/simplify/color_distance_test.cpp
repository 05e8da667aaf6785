#include "simplify/measure/color_distance.h"
#include "simplify/measure/srgb.h"

#include <cmath>
#include <cstring>
#include <gtest/gtest.h>
#include <stb_image_write.h>

namespace lodestone {

namespace {

using Rgb = std::array<std::uint8_t, 3>;

// A PNG of one row.
Image rowImage(const std::vector<Rgb>& texels) {
    auto bytes = std::make_shared<std::vector<std::byte>>();
    const auto append = [](void* target, void* data, int size) {
        const auto* begin = static_cast<const std::byte*>(data);
        auto& all = *static_cast<std::vector<std::byte>*>(target);
        all.insert(all.end(), begin, begin + size);
    };
    stbi_write_png_to_func(
        append, bytes.get(), static_cast<int>(texels.size()), 1, 3, texels.data(), 0);
    Image image;
    image.name = "row";
    image.bytes = bytes;
    return image;
}

template <class Value>
Attribute floats(const std::string& semantic, const std::vector<Value>& values) {
    Attribute attribute;
    attribute.semantic = semantic;
    attribute.components = sizeof(Value) / sizeof(float);
    attribute.bytes.resize(values.size() * sizeof(Value));
    std::memcpy(attribute.bytes.data(), values.data(), attribute.bytes.size());
    return attribute;
}

// A unit square with u along x; one material.
Scene squareScene() {
    const auto geometry = std::make_shared<Geometry>();
    geometry->positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    geometry->indices = {0, 1, 2, 0, 2, 3};
    geometry->attributes.push_back(
        floats("TEXCOORD_0", std::vector<glm::vec2>{{0, 0}, {1, 0}, {1, 1}, {0, 1}}));
    Scene scene;
    scene.name = "square.glb";
    Primitive primitive;
    primitive.geometry = geometry;
    primitive.material = 0;
    scene.submeshes.push_back({"square", {primitive}});
    scene.instances.push_back({glm::dmat4(1.0), 0, kNone, kNone});
    scene.materials.emplace_back();
    return scene;
}

Scene coloredSquare(const glm::vec4& linear) {
    Scene scene = squareScene();
    scene.materials[0].base_color = linear;
    return scene;
}

Scene texturedSquare(const std::vector<Rgb>& texels, bool nearest = true) {
    Scene scene = squareScene();
    scene.images.push_back(rowImage(texels));
    scene.materials[0].base_color_texture.image = 0;
    scene.materials[0].base_color_texture.nearest = nearest;
    return scene;
}

ColorDistance measure(const Scene& a, const Scene& b) {
    const Lod lod_a = fullLod(a);
    const Lod lod_b = fullLod(b);
    const Result<ColorDistance> distance =
        measureColorDistance({&a, &lod_a}, {&b, &lod_b}, {4000, 1}, {});
    EXPECT_TRUE(distance);
    return distance.value_or(ColorDistance{});
}

} // namespace

TEST(ColorDistance, OfASceneToItselfIsZero) {
    const Scene scene = texturedSquare({{255, 0, 0}, {0, 0, 255}, {10, 200, 30}}, false);
    const ColorDistance distance = measure(scene, scene);
    EXPECT_NEAR(distance.mean, 0.0, 1e-5);
    EXPECT_EQ(distance.samples, 8000u);
    EXPECT_TRUE(distance.notes.empty());
}

TEST(ColorDistance, OfRedAndGreenIsTheDiagonalOfTheirSquare) {
    const ColorDistance distance =
        measure(coloredSquare({1, 0, 0, 1}), coloredSquare({0, 1, 0, 1}));
    EXPECT_NEAR(distance.mean, std::sqrt(2.0), 1e-9);
    EXPECT_NEAR(distance.a_to_b, distance.b_to_a, 1e-9);
}

TEST(ColorDistance, FactorsAreLinearAndTheDistanceIsInSrgb) {
    const ColorDistance distance =
        measure(coloredSquare({0.5f, 0, 0, 1}), coloredSquare({0, 0, 0, 1}));
    EXPECT_NEAR(distance.mean, srgbFromLinear(0.5), 1e-6);
    EXPECT_NEAR(srgbFromLinear(0.5), 0.735357, 1e-5);
}

TEST(ColorDistance, TextureAndFactorOfOneColorAreEqual) {
    // sRGB 188 is the byte nearest to half the light.
    const auto half = static_cast<float>(linearFromSrgb(188.0 / 255.0));
    const ColorDistance distance =
        measure(texturedSquare({{188, 0, 255}}), coloredSquare({half, 0, 1, 1}));
    EXPECT_NEAR(distance.mean, 0.0, 1e-5);
}

TEST(ColorDistance, TextureFactorAndVertexColorMultiply) {
    Scene all = texturedSquare({{188, 188, 188}});
    all.materials[0].base_color = {0.5f, 1, 1, 1};
    const auto colored = std::make_shared<Geometry>(*all.submeshes[0].primitives[0].geometry);
    colored->attributes.push_back(
        floats("COLOR_0", std::vector<glm::vec3>(4, glm::vec3(1.0f, 0.25f, 1.0f))));
    all.submeshes[0].primitives[0].geometry = colored;
    const auto half = static_cast<float>(linearFromSrgb(188.0 / 255.0));
    EXPECT_NEAR(measure(all, coloredSquare({0.5f * half, 0.25f * half, half, 1})).mean, 0.0, 1e-5);
}

TEST(ColorDistance, NearestTexelsCoverTheirShareOfTheSurface) {
    // A quarter of the square is blue, the rest red.
    const ColorDistance distance =
        measure(texturedSquare({{255, 0, 0}, {255, 0, 0}, {255, 0, 0}, {0, 0, 255}}),
                coloredSquare({1, 0, 0, 1}));
    EXPECT_NEAR(distance.mean, 0.25 * std::sqrt(2.0), 0.01);
}

TEST(ColorDistance, CoordinatesAreTransformedAndWrapped) {
    // Moved by a whole texture, repeated: the same. Clamped: the last texel everywhere.
    const std::vector<Rgb> texels = {{255, 0, 0}, {0, 255, 0}};
    const Scene plain = texturedSquare(texels);
    Scene moved = texturedSquare(texels);
    moved.materials[0].base_color_texture.uv_transform[2] = {1, 0, 1};
    EXPECT_NEAR(measure(plain, moved).mean, 0.0, 1e-5);
    moved.materials[0].base_color_texture.wrap_u = TextureWrap::ClampToEdge;
    EXPECT_NEAR(measure(moved, coloredSquare({0, 1, 0, 1})).mean, 0.0, 1e-5);
    moved.materials[0].base_color_texture.wrap_u = TextureWrap::MirroredRepeat;
    EXPECT_NEAR(measure(moved, plain).mean, std::sqrt(2.0), 0.01);
}

TEST(ColorDistance, UnreadableImageCountsAsWhiteAndIsNamed) {
    Scene broken = texturedSquare({{255, 0, 0}});
    broken.images[0].bytes = std::make_shared<const std::vector<std::byte>>(100, std::byte{0x42});
    const ColorDistance distance = measure(broken, coloredSquare({1, 1, 1, 1}));
    EXPECT_NEAR(distance.mean, 0.0, 1e-6);
    ASSERT_EQ(distance.notes.size(), 1u);
    EXPECT_NE(distance.notes[0].find("square.glb: image 0 'row'"), std::string::npos);
}

TEST(ColorDistance, BothWaysAreAveraged) {
    // B has a black square far away besides, so half of its samples see white from black.
    const Scene white = coloredSquare({1, 1, 1, 1});
    Scene both = white;
    both.submeshes.push_back(both.submeshes[0]);
    both.submeshes[1].primitives[0].material = 1;
    both.materials.emplace_back();
    both.materials[1].base_color = {0, 0, 0, 1};
    glm::dmat4 away(1.0);
    away[3][0] = 10.0;
    both.instances.push_back({away, 1, kNone, kNone});
    const ColorDistance distance = measure(white, both);
    EXPECT_NEAR(distance.a_to_b, 0.0, 1e-6);
    EXPECT_NEAR(distance.b_to_a, 0.5 * std::sqrt(3.0), 1e-3);
    EXPECT_NEAR(distance.mean, 0.25 * std::sqrt(3.0), 1e-3);
}

} // namespace lodestone
