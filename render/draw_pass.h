#pragma once
// Inside render/ only: draws a LOD into the framebuffer that is bound.
#include "render/culling.h"
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

// Where a draw that is spread over several calls goes on.
struct DrawCursor {
    std::size_t item = 0; // in LodState::items
    std::uint32_t begin =
        0; // of that item's seen instances, or of its indices if it has one instance
    bool finished = false;        // every surface is drawn
    std::size_t mark = 0;         // where highlights go on: highlight * items + item
    std::uint32_t mark_begin = 0; // as begin, of that item's kept instances
    bool complete = false;        // finished, and what lies over the surfaces is drawn, too
    Culling* culling = nullptr;   // prepared for the picture; null: every instance is drawn
};

// Draws surfaces from the cursor on and moves it. Stops once about most_triangles are drawn,
// instances counted; transparent instances come last and at once.
// Errors: Failed for a shader that does not compile.
Result<DrawTotals> drawLod(const View::Input& input,
                           const Antialiasing& antialiasing,
                           DrawCursor& cursor,
                           std::uint64_t most_triangles);

// Draws what lies over the surfaces once all are there, from the cursor on: highlights, then the
// floor's grid. Stops as drawLod() does; errors as there.
Result<void> drawOver(const View::Input& input,
                      const Antialiasing& antialiasing,
                      DrawCursor& cursor,
                      std::uint64_t most_triangles);

} // namespace lodestone
