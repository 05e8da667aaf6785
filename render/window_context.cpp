#include "render/gl_context.h"
#include "render/gl_info.h"

#ifdef LODESTONE_WITH_WINDOW
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#endif

#include <string>

namespace lodestone {

#ifdef LODESTONE_WITH_WINDOW

namespace {

std::string glfwMessage() {
    const char* text = nullptr;
    glfwGetError(&text);
    return text != nullptr ? text : "no reason given";
}

class WindowContext final : public GlContext {
public:
    WindowContext() = default;

    ~WindowContext() override {
        if (window_ != nullptr)
            glfwDestroyWindow(window_);
        if (initialised_)
            glfwTerminate();
    }

    Result<void> open(const WindowOptions& options) {
        if (glfwInit() != GLFW_TRUE)
            return fail(ErrorKind::Failed,
                        "no window: " + glfwMessage() +
                            "; start it in a desktop session or use the commands (--help)");
        initialised_ = true;
        glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
        glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
        glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
        glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
        glfwWindowHint(GLFW_DEPTH_BITS, 0);
        glfwWindowHint(GLFW_STENCIL_BITS, 0);
        glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
        glfwWindowHint(GLFW_VISIBLE,
                       options.visibility == WindowVisibility::Shown ? GLFW_TRUE : GLFW_FALSE);
        window_ = glfwCreateWindow(
            options.width_px, options.height_px, options.title.c_str(), nullptr, nullptr);
        if (window_ == nullptr)
            return fail(ErrorKind::Failed,
                        "no window with OpenGL 3.3: " + glfwMessage() +
                            "; update the graphics driver");
        glfwMakeContextCurrent(window_);
        glfwSwapInterval(options.vsync == VerticalSync::On ? 1 : 0);
        Result<GlInfo> info = loadContext(glfwGetProcAddress);
        if (!info)
            return tl::unexpected(info.error());
        info_ = *info;
        return {};
    }

    void makeCurrent() override { glfwMakeContextCurrent(window_); }

    void* nativeWindow() const override { return window_; }

    void swapBuffers() override { glfwSwapBuffers(window_); }

private:
    GLFWwindow* window_ = nullptr;
    bool initialised_ = false;
};

} // namespace

Result<std::unique_ptr<GlContext>> createWindowContext(const WindowOptions& options) {
    if (options.width_px < 1 || options.height_px < 1)
        return fail(ErrorKind::Usage, "window: width and height must be at least 1 px");
    auto context = std::make_unique<WindowContext>();
    if (Result<void> opened = context->open(options); !opened)
        return tl::unexpected(opened.error());
    return context;
}

#else

Result<std::unique_ptr<GlContext>> createWindowContext(const WindowOptions&) {
    return fail(ErrorKind::Failed,
                "no window: built without one; configure with -DLODESTONE_WITH_WINDOW=ON");
}

#endif

} // namespace lodestone
