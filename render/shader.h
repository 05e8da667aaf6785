#pragma once
// Shader texts (embedded; LODESTONE_SHADER_DIR overrides them) and their compilation.
#include "render/gl_object.h"
#include "scene/result.h"

#include <array>
#include <span>
#include <string>
#include <string_view>

namespace lodestone {

struct ShaderText {
    std::string_view name; // file in shaders/
    std::string_view text;
};

constexpr std::size_t kShaderFiles = 8;
extern const std::array<ShaderText, kShaderFiles> kShaderTexts; // made by shaders/embed.cmake

struct ProgramFiles {
    std::string_view vertex;
    std::string_view geometry; // empty: none
    std::string_view fragment;
};

// Compiles and links; every name in defines becomes "#define NAME 1" in all stages. common.glsl
// comes first in every stage that is not of the background.
// Errors: Failed names file and line of the first message, or BadInput the unreadable override.
Result<GlProgram> buildProgram(const ProgramFiles& files,
                               std::span<const std::string_view> defines);

} // namespace lodestone
