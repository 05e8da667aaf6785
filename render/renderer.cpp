#include "render/renderer.h"

#include "render/renderer_state.h"
#include "render/shader.h"

#include <array>
#include <vector>

namespace lodestone {

namespace {

constexpr std::array<std::string_view, 32> kFeatureNames{
    "HAS_NORMAL",    "HAS_UV0",          "HAS_UV1",
    "HAS_COLOR",     "MIXED_MIRROR",     "BY_INSTANCE",
    "WIREFRAME",     "BASE_MAP",         "METALLIC_ROUGHNESS_MAP",
    "NORMAL_MAP",    "OCCLUSION_MAP",    "EMISSIVE_MAP",
    "ALPHA_MASK",    "ALPHA_BLEND",      "UNLIT",
    "NO_SURFACE",    "FACETS",           "SHADE_LIT",
    "SHADE_CLAY",    "SHADE_BASE_COLOR", "SHADE_UV",
    "SHADE_SUBMESH", "SHADE_NORMALS",    "HAS_VALUE",
    "SHADE_MATCAP",  "SHADE_VALUE",      "HIGHLIGHT",
    "POSED",         "HAS_JOINTS",       "HAS_MORE_JOINTS",
    "MORPHED",       "HAS_TANGENT"};

constexpr std::array<const char*, kMaterialMaps> kMapNames{
    "base_color_map", "metallic_roughness_map", "normal_map", "occlusion_map", "emissive_map"};

void bindBlock(GLuint program, const char* block, GLuint binding) {
    const GLuint index = glGetUniformBlockIndex(program, block);
    if (index != GL_INVALID_INDEX)
        glUniformBlockBinding(program, index, binding);
}

GLint glWrap(TextureWrap wrap) {
    switch (wrap) {
    case TextureWrap::ClampToEdge:
        return GL_CLAMP_TO_EDGE;
    case TextureWrap::MirroredRepeat:
        return GL_MIRRORED_REPEAT;
    case TextureWrap::Repeat:
        break;
    }
    return GL_REPEAT;
}

} // namespace

Result<Renderer> Renderer::create(const GlContext& context) {
    auto state = std::make_shared<RendererState>(context.info());
    if (Result<void> opened = state->open(); !opened)
        return tl::unexpected(opened.error());
    return Renderer(std::move(state));
}

const GlInfo& Renderer::info() const {
    return state_->info();
}

Result<void> RendererState::open() {
    Result<GlProgram> background = buildProgram({"background.vert", "", "background.frag"}, {});
    if (!background)
        return tl::unexpected(background.error());
    background_ = std::move(*background);
    background_lower_ = glGetUniformLocation(background_.name(), "lower");
    background_upper_ = glGetUniformLocation(background_.name(), "upper");
    Result<GlProgram> grid = buildProgram({"grid.vert", "", "grid.frag"}, {});
    if (!grid)
        return tl::unexpected(grid.error());
    grid_ = std::move(*grid);
    bindBlock(grid_.name(), "Frame", kFrameBinding);
    empty_ = GlVertexArray::create();
    frame_ = GlBuffer::create();
    white_ = GlTexture::create();
    glBindTexture(GL_TEXTURE_2D, white_.name());
    const std::array<std::uint8_t, 4> white{255, 255, 255, 255};
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, 1, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE, white.data());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    glBindTexture(GL_TEXTURE_2D, 0);
    glGetIntegerv(GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT, &uniform_alignment_);
    return {};
}

Result<const SceneProgram*> RendererState::sceneProgram(std::uint32_t features) {
    if (const auto found = programs_.find(features); found != programs_.end())
        return &found->second;
    std::vector<std::string_view> defines;
    for (std::size_t bit = 0; bit < kFeatureNames.size(); ++bit)
        if ((features >> bit & 1u) != 0)
            defines.push_back(kFeatureNames[bit]);
    const std::string_view geometry = (features & kWireframe) != 0 ? "scene.geom" : "";
    Result<GlProgram> built = buildProgram({"scene.vert", geometry, "scene.frag"}, defines);
    if (!built)
        return tl::unexpected(built.error());
    SceneProgram scene_program;
    scene_program.program = std::move(*built);
    const GLuint name = scene_program.program.name();
    bindBlock(name, "Frame", kFrameBinding);
    bindBlock(name, "Material", kMaterialBinding);
    scene_program.submesh_color = glGetUniformLocation(name, "submesh_color");
    scene_program.cull_back = glGetUniformLocation(name, "cull_back");
    scene_program.pose_row = glGetUniformLocation(name, "pose_row");
    scene_program.morph_shape = glGetUniformLocation(name, "morph_shape");
    glUseProgram(name);
    glUniform1i(glGetUniformLocation(name, "pose"), static_cast<GLint>(kPoseUnit));
    glUniform1i(glGetUniformLocation(name, "morph_deltas"), static_cast<GLint>(kMorphUnit));
    for (std::size_t unit = 0; unit < kMapNames.size(); ++unit)
        glUniform1i(glGetUniformLocation(name, kMapNames[unit]), static_cast<GLint>(unit));
    return &programs_.emplace(features, std::move(scene_program)).first->second;
}

GLuint RendererState::sampler(const SamplerKey& key) {
    GlSampler& sampler = samplers_[key];
    if (!sampler) {
        sampler = GlSampler::create();
        glSamplerParameteri(sampler.name(), GL_TEXTURE_WRAP_S, glWrap(key.wrap_u));
        glSamplerParameteri(sampler.name(), GL_TEXTURE_WRAP_T, glWrap(key.wrap_v));
        glSamplerParameteri(
            sampler.name(), GL_TEXTURE_MAG_FILTER, key.nearest ? GL_NEAREST : GL_LINEAR);
        glSamplerParameteri(sampler.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    }
    return sampler.name();
}

} // namespace lodestone
