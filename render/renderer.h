#pragma once
// What all views of a context share: programs compiled on demand, fixed textures, samplers.
#include "render/gl_context.h"
#include "scene/result.h"

#include <memory>

namespace lodestone {

// Opaque picture on the GPU, as user interfaces take it (ImTextureID); 0: none.
using TextureHandle = std::uint64_t;

class RendererState; // render/renderer_state.h, inside this folder

// Main thread; the context must outlive it and be current. Cheap to copy (shared state).
class Renderer {
public:
    // Compiles nothing but the basic programs. Errors: Failed names shader file, line and message.
    static Result<Renderer> create(const GlContext& context);

    const GlInfo& info() const;

    const std::shared_ptr<RendererState>& shared() const { return state_; }

private:
    explicit Renderer(std::shared_ptr<RendererState> state) : state_(std::move(state)) {}

    std::shared_ptr<RendererState> state_;
};

} // namespace lodestone
