#pragma once
// A view of small hand-made scenes, drawn off screen.
#include "render/view.h"
#include "tests/render/headless_test.h"

#include <cmath>
#include <cstring>
#include <optional>
#include <stb_image_write.h>

namespace lodestone::tests {

inline Attribute
floats(const std::string& semantic, int components, const std::vector<float>& values) {
    Attribute attribute;
    attribute.semantic = semantic;
    attribute.components = static_cast<std::uint8_t>(components);
    attribute.bytes.resize(values.size() * sizeof(float));
    std::memcpy(attribute.bytes.data(), values.data(), attribute.bytes.size());
    return attribute;
}

// The square -1..1 in the xy plane, facing +z; texture coordinates as glTF: v down.
inline GeometryPtr square(bool with_normals) {
    auto geometry = std::make_shared<Geometry>();
    geometry->positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    geometry->indices = {0, 1, 2, 0, 2, 3};
    if (with_normals)
        geometry->attributes.push_back(floats("NORMAL", 3, {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}));
    geometry->attributes.push_back(floats("TEXCOORD_0", 2, {0, 1, 1, 1, 1, 0, 0, 0}));
    return geometry;
}

inline void appendBytes(void* context, void* data, int size_bytes) {
    const auto* begin = static_cast<const std::byte*>(data);
    auto* bytes = static_cast<std::vector<std::byte>*>(context);
    bytes->insert(bytes->end(), begin, begin + size_bytes);
}

// 2 x 2 pixels, rows top-down.
inline Image pngImage(const std::vector<std::uint8_t>& rgba) {
    auto bytes = std::make_shared<std::vector<std::byte>>();
    stbi_write_png_to_func(appendBytes, bytes.get(), 2, 2, 4, rgba.data(), 8);
    Image image;
    image.mime_type = "image/png";
    image.bytes = bytes;
    return image;
}

inline std::shared_ptr<Scene> sceneOf(const GeometryPtr& geometry, const Material& material) {
    auto scene = std::make_shared<Scene>();
    scene->materials.push_back(material);
    Primitive primitive;
    primitive.geometry = geometry;
    primitive.material = 0;
    scene->submeshes.push_back({"square", {primitive}});
    scene->instances.emplace_back();
    return scene;
}

inline Material unlit(const glm::vec4& color) {
    Material material;
    material.base_color = color;
    material.unlit = true;
    return material;
}

class ViewTest : public HeadlessTest {
protected:
    static constexpr int kSize = 64;

    void SetUp() override {
        HeadlessTest::SetUp();
        if (!context_)
            return;
        Result<Renderer> renderer = Renderer::create(*context_);
        ASSERT_TRUE(renderer) << renderer.error().message;
        renderer_ = *renderer;
        Result<View> view = View::create(*renderer_);
        ASSERT_TRUE(view);
        view_ = std::move(*view);
    }

    // What the next pictures show.
    void load(const ScenePtr& scene, const Lod& lod) {
        lod_ = LodHandle();
        Result<GpuScene> gpu = GpuScene::create(*renderer_, scene);
        ASSERT_TRUE(gpu) << gpu.error().message;
        gpu_ = std::move(*gpu);
        const Result<UploadReport> uploaded = gpu_->update(lod_, lod);
        ASSERT_TRUE(uploaded) << uploaded.error().message;
        input_ = {};
        input_.scene = &*gpu_;
        input_.lod = &lod_;
        input_.size = {kSize, kSize};
    }

    // Loads the scene, aims a camera straight at the xy plane that shows -2..2.
    void load(const ScenePtr& scene) {
        load(scene, fullLod(*scene));
        input_.options.background = Background::Solid;
        input_.options.background_srgb = glm::vec3(0.0f);
        input_.camera.azimuth_rad = 0.0;
        input_.camera.elevation_rad = 0.0;
        input_.camera.orthographic = true;
        input_.camera.target = gpu_->bounds().center();
        input_.camera.scene_center = input_.camera.target;
        input_.camera.scene_radius = 10.0;
        input_.camera.distance = 2.0 / std::tan(input_.camera.yfov_rad * 0.5);
    }

    Pixels draw() {
        const Result<DrawReport> report = view_->draw(input_);
        EXPECT_TRUE(report) << report.error().message;
        if (report)
            report_ = *report;
        const Result<Pixels> pixels = view_->readPixels();
        EXPECT_TRUE(pixels);
        return pixels ? *pixels : Pixels(kSize, kSize, {});
    }

    // x, y: -2..2, y up.
    static Rgba8 at(const Pixels& pixels, double x, double y) {
        return pixels.at(static_cast<std::uint32_t>((x + 2.0) / 4.0 * kSize),
                         static_cast<std::uint32_t>((2.0 - y) / 4.0 * kSize));
    }

    static double litShare(const Pixels& pixels) {
        std::size_t lit = 0;
        for (std::size_t i = 0; i < pixels.rgba.size(); i += 4)
            lit += pixels.rgba[i] + pixels.rgba[i + 1] + pixels.rgba[i + 2] > 24 ? 1 : 0;
        return 4.0 * static_cast<double>(lit) / static_cast<double>(pixels.rgba.size());
    }

    std::optional<Renderer> renderer_;
    std::optional<GpuScene> gpu_;
    LodHandle lod_;
    std::optional<View> view_;
    View::Input input_;
    DrawReport report_;
};

inline void expectColor(const Rgba8& found, const Rgba8& wanted, int tolerance = 3) {
    for (std::size_t c = 0; c < 4; ++c)
        EXPECT_NEAR(int(found[c]), int(wanted[c]), tolerance) << "channel " << c;
}

} // namespace lodestone::tests
