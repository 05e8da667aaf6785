#pragma once
// Inside render/ only: draws a LOD into the framebuffer that is bound.
#include "render/gpu_scene_state.h"
#include "render/view.h"

namespace lodestone {

// How edges are smoothed: by multisampling, or by drawing larger and scaling down.
struct Antialiasing {
    int samples = 1;
    int scale = 1; // of width and height

    bool operator==(const Antialiasing&) const = default;
};

struct DrawTotals {
    std::uint32_t draw_calls = 0;
    std::uint64_t triangles = 0;
};

void drawBackground(const RendererState& renderer, const ViewOptions& options);

// Errors: Failed for a shader that does not compile.
Result<DrawTotals> drawLod(const View::Input& input, const Antialiasing& antialiasing);

} // namespace lodestone
