#include "render/frame_block.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace lodestone {

namespace {

// The level below the scene and its grid: a line every power of ten of a world unit, some twenty
// across the scene. x: height in scene units; y: lines a scene unit; zw: the first line.
glm::vec4 floorOf(const GpuSceneState& scene) {
    if (scene.bounds.empty)
        return glm::vec4(0.0f);
    const double spacing = std::pow(10.0, std::floor(std::log10(scene.frame.radius))) * 0.5;
    const double height = (scene.bounds.min.y - scene.frame.center.y) / scene.frame.radius;
    const glm::dvec2 phase(std::fmod(scene.frame.center.x / spacing, 10.0),
                           std::fmod(scene.frame.center.z / spacing, 10.0));
    return {height, scene.frame.radius / spacing, phase.x, phase.y};
}

// The camera with its near and far planes around what the pose may have moved out, too.
OrbitCamera reaching(OrbitCamera camera, const Bounds& reach) {
    if (!reach.empty)
        camera.scene_radius =
            std::max(camera.scene_radius,
                     glm::length(reach.center() - camera.scene_center) + reach.diagonal() * 0.5);
    return camera;
}

// In the scene's units, which texels are counted along.
float valueFull(const View::Input& input) {
    const float full = input.options.value_full;
    if (input.options.shading != Shading::ByTexels)
        return full;
    return full * static_cast<float>(input.scene->state().frame.radius);
}

} // namespace

FrameBlock frameBlock(const View::Input& input, const Antialiasing& antialiasing) {
    const SceneFrame& frame = input.scene->state().frame;
    const glm::dmat4 view = viewMatrix(input.camera);
    const glm::dmat4 projection = projectionMatrix(
        reaching(input.camera, input.scene->state().pose.reach), input.size.aspect());
    const glm::dmat4 world_from_scene =
        glm::scale(glm::translate(glm::dmat4(1.0), frame.center), glm::dvec3(frame.radius));
    const glm::dmat3 axes = glm::transpose(glm::dmat3(view));
    const double azimuth = input.options.light_azimuth_rad;
    const double elevation = input.options.light_elevation_rad;
    const glm::dvec3 light = axes * glm::dvec3(std::cos(elevation) * std::sin(azimuth),
                                               std::sin(elevation),
                                               std::cos(elevation) * std::cos(azimuth));
    FrameBlock block;
    block.clip_from_scene = glm::mat4(projection * view * world_from_scene);
    const glm::dvec2 middle =
        glm::dvec2(input.size.width_px, input.size.height_px) * (antialiasing.scale * 0.5);
    block.drawn = glm::vec4(middle, std::tan(input.camera.yfov_rad * 0.5) / middle.y, 0.0);
    block.right = glm::vec4(axes[0], 0.0);
    block.up = glm::vec4(axes[1], 0.0);
    block.back = glm::vec4(axes[2], input.camera.orthographic ? 1.0 : 0.0);
    block.key_light = glm::vec4(light, 0.0);
    block.viewport = glm::vec4(input.size.width_px,
                               input.size.height_px,
                               input.options.exposure,
                               antialiasing.samples > 1 ? 1.0f : 0.0f);
    block.wire_color = glm::vec4(input.options.wire_srgb, 1.0f);
    block.highlight_color = glm::vec4(input.options.highlight_srgb, 0.55f);
    const glm::vec3 luma(0.2126f, 0.7152f, 0.0722f);
    const float brightness = glm::dot(input.options.background_srgb, luma);
    block.display = glm::vec4(
        1.0f / std::max(input.options.shininess, 1e-3f),
        1.0f / std::max(valueFull(input), 1e-30f),
        brightness < 0.4f ? 1.0f : 0.0f,
        input.options.value_span > 1.0f ? 1.0f / std::log2(input.options.value_span) : 0.0f);
    block.floor = floorOf(input.scene->state());
    for (std::size_t i = 0; i < block.value_colors.size(); ++i)
        block.value_colors[i] = glm::vec4(input.options.value_colors[i], 1.0f);
    return block;
}

FrameBlock nearerFrameBlock(const View::Input& input, const Antialiasing& antialiasing) {
    constexpr double kNearer = 0.003; // of the scene's radius: some LODs' error
    FrameBlock block = frameBlock(input, antialiasing);
    const glm::dmat4 projection = projectionMatrix(input.camera, input.size.aspect());
    const double shift = projection[2][2] * kNearer * input.scene->state().frame.radius;
    block.clip_from_scene[3][2] += static_cast<float>(shift);
    return block;
}

} // namespace lodestone
