#pragma once
// An OpenGL 3.3 core context: with a window (GLFW) or without any display (surfaceless EGL).
// Main thread only. The context is current on the creating thread from creation on.
#include "scene/result.h"

#include <cstdint>
#include <memory>
#include <string>

namespace lodestone {

struct GlInfo {
    std::string renderer;     // GL_RENDERER
    std::string version;      // GL_VERSION
    bool is_software = false; // llvmpipe, softpipe, swrast: timer queries are meaningless there
    int max_samples = 1;
    int max_texture_size_px = 2048;
};

class GlContext {
public:
    virtual ~GlContext() = default;
    GlContext(const GlContext&) = delete;
    GlContext& operator=(const GlContext&) = delete;

    const GlInfo& info() const { return info_; }

    virtual void makeCurrent() = 0;

    // GLFWwindow* for the glue of a user interface; nullptr without a window.
    virtual void* nativeWindow() const { return nullptr; }

    // Shows the back buffer; nothing to do without a window.
    virtual void swapBuffers() {}

protected:
    GlContext() = default;
    GlInfo info_;
};

enum class WindowVisibility : std::uint8_t { Shown, Hidden };
enum class VerticalSync : std::uint8_t { On, Off };

struct WindowOptions {
    int width_px = 1280;
    int height_px = 720;
    std::string title = "Lodestone";
    WindowVisibility visibility = WindowVisibility::Shown;
    VerticalSync vsync = VerticalSync::On;
};

// Needs no display. Errors: Failed names what EGL refused.
Result<std::unique_ptr<GlContext>> createHeadlessContext();

// Errors: Failed when there is no display, or the program was built without a window. Initialises
// GLFW (and terminates it again with the last window).
Result<std::unique_ptr<GlContext>> createWindowContext(const WindowOptions& options);

// Clears the window's own framebuffer; the colour is sRGB 0..1. For the frame around an interface.
struct WindowClear {
    int width_px = 0;
    int height_px = 0;
    float red = 0.0f;
    float green = 0.0f;
    float blue = 0.0f;
};

void clearWindow(const WindowClear& clear);

} // namespace lodestone
