#pragma once
// Inside render/ only: what Renderer shares among its scenes and views.
#include "render/gl_object.h"
#include "render/renderer.h"
#include "render/slice_pace.h"
#include "scene/scene.h"

#include <cstdint>
#include <map>
#include <tuple>
#include <unordered_map>

namespace lodestone {

// What a program of the scene is compiled for; bit i is the i-th define of kFeatureNames.
enum Feature : std::uint32_t {
    kHasNormal = 1u << 0,
    kHasUv0 = 1u << 1,
    kHasUv1 = 1u << 2,
    kHasColor = 1u << 3,
    kMixedMirror = 1u << 4, // instances of both hands: culled in the fragment shader
    kByInstance = 1u << 5,
    kWireframe = 1u << 6,
    kBaseMap = 1u << 7,
    kMetallicRoughnessMap = 1u << 8,
    kNormalMap = 1u << 9,
    kOcclusionMap = 1u << 10,
    kEmissiveMap = 1u << 11,
    kAlphaMask = 1u << 12,
    kAlphaBlend = 1u << 13,
    kUnlit = 1u << 14,
    kNoSurface = 1u << 15, // points and lines
    kFacets = 1u << 16,    // normals from screen derivatives
    kShadeLit = 1u << 17,
    kShadeClay = 1u << 18,
    kShadeBaseColor = 1u << 19,
    kShadeUv = 1u << 20,
    kShadeSubmesh = 1u << 21,
    kShadeNormals = 1u << 22,
    kHasValue = 1u << 23,
    kShadeMatcap = 1u << 24,
    kShadeValue = 1u << 25,
    kHighlight = 1u << 26, // one translucent colour over what is drawn
    kPosed = 1u << 27,     // transforms from the pose's texels
    kHasJoints = 1u << 28,
    kHasMoreJoints = 1u << 29, // joints five to eight
    kMorphed = 1u << 30,
    kHasTangent = 1u << 31,
};

constexpr std::uint32_t kAnyMap =
    kBaseMap | kMetallicRoughnessMap | kNormalMap | kOcclusionMap | kEmissiveMap;
constexpr std::size_t kMaterialMaps = 5; // units 0..4, in the order of the map features

struct SceneProgram {
    GlProgram program;
    GLint submesh_color = -1;
    GLint cull_back = -1;
    GLint pose_row = -1;
    GLint morph_shape = -1;
};

struct SamplerKey {
    TextureWrap wrap_u = TextureWrap::Repeat;
    TextureWrap wrap_v = TextureWrap::Repeat;
    bool nearest = false;

    bool operator<(const SamplerKey& other) const {
        return std::tie(wrap_u, wrap_v, nearest) <
               std::tie(other.wrap_u, other.wrap_v, other.nearest);
    }
};

// Units of the texture buffers, behind the maps.
constexpr GLuint kPoseUnit = kMaterialMaps;
constexpr GLuint kMorphUnit = kMaterialMaps + 1;

// Uniform blocks: binding points.
constexpr GLuint kFrameBinding = 0;
constexpr GLuint kMaterialBinding = 1;

class RendererState {
public:
    explicit RendererState(GlInfo info) : info_(std::move(info)) {}

    Result<void> open();

    const GlInfo& info() const { return info_; }

    // Compiles on first use. Errors: Failed as buildProgram.
    Result<const SceneProgram*> sceneProgram(std::uint32_t features);
    GLuint sampler(const SamplerKey& key);

    const GlProgram& backgroundProgram() const { return background_; }

    GLint backgroundLower() const { return background_lower_; }

    GLint backgroundUpper() const { return background_upper_; }

    const GlProgram& gridProgram() const { return grid_; }

    GLuint emptyVertexArray() const { return empty_.name(); }

    GLuint whiteTexture() const { return white_.name(); }

    GLuint frameBuffer() const { return frame_.name(); }

    GLint uniformAlignment() const { return uniform_alignment_; }

    std::uint64_t nextRevision() { return ++revision_; }

    SlicePace& slicePace() { return slice_pace_; } // of all views: they share the processor

private:
    GlInfo info_;
    std::unordered_map<std::uint32_t, SceneProgram> programs_;
    std::map<SamplerKey, GlSampler> samplers_;
    GlProgram background_;
    GLint background_lower_ = -1;
    GLint background_upper_ = -1;
    GlProgram grid_;
    GlVertexArray empty_;
    GlTexture white_;
    GlBuffer frame_;
    GLint uniform_alignment_ = 256;
    std::uint64_t revision_ = 0;
    SlicePace slice_pace_;
};

} // namespace lodestone
