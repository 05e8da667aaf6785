#pragma once
// Inside render/ only: what all draws of a picture share, as the shaders read it.
#include "render/draw_pass.h"

#include <array>

namespace lodestone {

// Layout of the uniform block Frame in shaders/common.glsl (std140).
struct FrameBlock {
    glm::mat4 clip_from_scene;
    glm::vec4 drawn;
    glm::vec4 right;
    glm::vec4 up;
    glm::vec4 back;
    glm::vec4 key_light;
    glm::vec4 viewport;
    glm::vec4 wire_color;
    glm::vec4 highlight_color;
    glm::vec4 display;
    glm::vec4 floor;
    std::array<glm::vec4, 9> value_colors;
};

// input: with a scene. Positions are those of the scene's frame.
FrameBlock frameBlock(const View::Input& input, const Antialiasing& antialiasing);

// The same with every depth a little nearer to the eye, so that it shows over a surface that lies
// where it does, or nearly so.
FrameBlock nearerFrameBlock(const View::Input& input, const Antialiasing& antialiasing);

} // namespace lodestone
