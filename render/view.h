#pragma once
// A view: an off-screen picture of one LOD, redrawn only when something changed.
#include "render/camera.h"
#include "render/gpu_scene.h"
#include "render/pixels.h"

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <memory>
#include <vector>

namespace lodestone {

enum class Shading : std::uint8_t {
    Lit,        // materials as the file has them
    Clay,       // one soft grey material
    Normals,    // world normal as colour
    Flat,       // facets, base colour
    UvChecker,  // checker board on TEXCOORD_0
    BySubmesh,  // one colour for each submesh
    ByInstance, // one colour for each instance
    Matcap,     // a studio that turns with the camera, for shape
    ByLodState, // value_colors by the share of its triangles that a submesh has lost
    ByTexels,   // value_colors by texels of the base colour a world unit; grey without a texture
    ByValue,    // value_colors by kVertexValueSemantic; grey where there is none
};

enum class Background : std::uint8_t { Solid, Gradient, Transparent };
enum class BackFaces : std::uint8_t { PerMaterial, Shown };

// Marked in the picture: a submesh, or one of its instances.
struct Highlight {
    std::uint32_t submesh = 0;
    std::uint32_t instance = kNone; // in Scene::instances; kNone: all

    bool operator==(const Highlight&) const = default;
};

struct ViewOptions {
    Shading shading = Shading::Lit;
    bool wireframe = false; // edges over the shading
    Background background = Background::Gradient;
    glm::vec3 background_srgb{0x1a / 255.0f, 0x1e / 255.0f, 0x23 / 255.0f}; // middle of a gradient
    glm::vec3 wire_srgb{0.30f, 0.76f, 0.63f};
    BackFaces back_faces = BackFaces::PerMaterial;
    // Key light relative to the camera, so that every side of a model can be seen lit.
    float light_azimuth_rad = -0.7f;
    float light_elevation_rad = 0.85f;
    float exposure = 1.0f;
    float shininess = 1.0f;                  // > 0; divides every roughness
    bool grid = false;                       // floor under the scene's bounds
    std::array<glm::vec3, 9> value_colors{}; // sRGB, evenly spaced from 0 to 1
    float value_full = 1.0f;                 // > 0; the value that has the last colour
    // > 1: a logarithmic scale, value_full / value_span has the first colour. Else linear from 0.
    float value_span = 0.0f;
    std::vector<Highlight> highlighted; // what the scene does not have is ignored
    glm::vec3 highlight_srgb{0.30f, 0.76f, 0.63f};
    Moment moment; // of the scene's animations; GpuScene::setMoment() first
    // 1: hard edges. Else MSAA, clamped to what the GPU has; software renderers, which are slow at
    // that, draw LODs of many triangles 2 x 2 as large instead. 1 while dragging is cheapest.
    int samples = 4;

    bool operator==(const ViewOptions&) const = default;
};

struct ViewSize {
    int width_px = 640;
    int height_px = 480;

    double aspect() const { return height_px > 0 ? double(width_px) / height_px : 1.0; }

    bool operator==(const ViewSize&) const = default;
};

struct DrawReport {
    bool drew = false;       // false: nothing changed since the last call, or not complete yet
    bool complete = true;    // false: the budget was spent; call again with the same input
    bool cost_known = false; // timer queries answer a frame or two later
    double cost_ms = 0.0;    // of the last measured draw of this view
    std::uint64_t triangles = 0;
    std::uint32_t draw_calls = 0;
};

struct MeasureOptions {
    int warmup_frames = 100; // not counted
    int frames = 1000;       // the 100th to the 1,100th rendering
    double budget_s = 0.0;   // > 0: stops early after that many seconds (at least one frame counts)
};

struct MeasureReport {
    double mean_ms = 0.0; // of a counted frame
    double fps = 0.0;
    std::uint64_t frames = 0;
};

class ViewState;

// Move-only. Main thread, context current.
class View {
public:
    static Result<View> create(const Renderer& renderer);
    View(View&&) noexcept;
    View& operator=(View&&) noexcept;
    ~View();

    struct Input {
        const GpuScene* scene = nullptr; // null or without a valid LOD: background only
        const LodHandle* lod = nullptr;
        OrbitCamera camera;
        ViewOptions options;
        ViewSize size;
        // Set: what is highlighted are submeshes and instances of this LOD of another scene, whose
        // surfaces lie about where those of `scene` do, which has dissolved them.
        const GpuScene* marked_scene = nullptr;
        const LodHandle* marked_lod = nullptr; // set as marked_scene is
    };

    // Draws if scene, LOD, camera, options or size changed. Leaves the window's framebuffer bound.
    // budget_ms: where the CPU draws, a call stops soon after it, and the picture before stays
    // until calls with an equal input have completed the new one; elsewhere it has no effect.
    // Errors: Usage for a size beyond the GPU's limit; Failed for a shader that does not compile.
    Result<DrawReport> draw(const Input& input, double budget_ms = kNoBudget);
    static constexpr double kNoBudget = std::numeric_limits<double>::infinity();
    void invalidate(); // the next draw() draws

    // The picture, bottom row first as GL has it: show with uv (0,1)-(1,0). Valid until the next
    // draw() of another size.
    TextureHandle texture() const;
    ViewSize size() const;
    Result<Pixels> readPixels() const; // of the last draw; top row first

    // The papers' protocol (six point-cloud methods, 2023): renders off-screen again and again, no
    // vsync, mean over the frames after the warm-up. Blocks. Errors as draw().
    Result<MeasureReport> measure(const Input& input, const MeasureOptions& options);

private:
    explicit View(std::unique_ptr<ViewState> state);
    std::unique_ptr<ViewState> state_;
};

} // namespace lodestone
