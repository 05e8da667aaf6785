#include "render/gl_context.h"

#include "render/gl_info.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <algorithm>
#include <cctype>
#include <cstring>
#include <string>

namespace lodestone {

namespace {

std::string glString(GLenum name) {
    const GLubyte* text = glGetString(name);
    return text != nullptr ? std::string(reinterpret_cast<const char*>(text)) : std::string();
}

bool isSoftwareRenderer(std::string renderer) {
    std::transform(renderer.begin(), renderer.end(), renderer.begin(), [](unsigned char c) {
        return static_cast<char>(std::tolower(c));
    });
    for (const char* name : {"llvmpipe", "softpipe", "swrast", "software rasterizer", "swr"})
        if (renderer.find(name) != std::string::npos)
            return true;
    return false;
}

Error eglError(const std::string& step) {
    return {ErrorKind::Failed,
            "EGL refused to " + step + " (error " + std::to_string(eglGetError()) +
                "); install a Mesa or vendor EGL driver"};
}

class HeadlessContext final : public GlContext {
public:
    HeadlessContext() = default;

    ~HeadlessContext() override {
        if (display_ == EGL_NO_DISPLAY)
            return;
        eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        if (context_ != EGL_NO_CONTEXT)
            eglDestroyContext(display_, context_);
        // The display is shared by all contexts of the process: it stays initialised.
    }

    Result<void> open() {
        if (Result<void> opened = openDisplay(); !opened)
            return opened;
        if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE)
            return tl::unexpected(eglError("bind OpenGL"));
        const EGLint config_wish[] = {
            EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
        EGLConfig config = nullptr;
        EGLint config_count = 0;
        if (eglChooseConfig(display_, config_wish, &config, 1, &config_count) != EGL_TRUE ||
            config_count == 0)
            config = nullptr; // EGL_NO_CONFIG_KHR
        const EGLint context_wish[] = {EGL_CONTEXT_MAJOR_VERSION,
                                       3,
                                       EGL_CONTEXT_MINOR_VERSION,
                                       3,
                                       EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                       EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                       EGL_NONE};
        context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT, context_wish);
        if (context_ == EGL_NO_CONTEXT)
            return tl::unexpected(eglError("create an OpenGL 3.3 core context"));
        if (eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) != EGL_TRUE)
            return tl::unexpected(eglError("make a context current without a surface"));
        Result<GlInfo> info = loadContext(eglGetProcAddress);
        if (!info)
            return tl::unexpected(info.error());
        info_ = *info;
        return {};
    }

    void makeCurrent() override {
        eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_);
    }

private:
    Result<void> openDisplay() {
        const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
        const auto get_display = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
            eglGetProcAddress("eglGetPlatformDisplayEXT"));
        if (extensions != nullptr && get_display != nullptr &&
            std::strstr(extensions, "EGL_MESA_platform_surfaceless") != nullptr)
            display_ = get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
        if (display_ == EGL_NO_DISPLAY)
            display_ = eglGetDisplay(EGL_DEFAULT_DISPLAY);
        if (display_ == EGL_NO_DISPLAY)
            return tl::unexpected(eglError("open a display"));
        if (eglInitialize(display_, nullptr, nullptr) != EGL_TRUE)
            return tl::unexpected(eglError("initialise"));
        return {};
    }

    EGLDisplay display_ = EGL_NO_DISPLAY;
    EGLContext context_ = EGL_NO_CONTEXT;
};

} // namespace

Result<GlInfo> loadContext(GlProcLookup lookup) {
    if (!loadGl(lookup))
        return fail(ErrorKind::Failed, "OpenGL functions cannot be loaded; check the driver");
    GlInfo info;
    info.renderer = glString(GL_RENDERER);
    info.version = glString(GL_VERSION);
    info.is_software = isSoftwareRenderer(info.renderer);
    GLint major = 0;
    GLint minor = 0;
    glGetIntegerv(GL_MAJOR_VERSION, &major);
    glGetIntegerv(GL_MINOR_VERSION, &minor);
    if (major * 10 + minor < 33)
        return fail(ErrorKind::Failed,
                    "OpenGL 3.3 is needed, the driver offers '" + info.version + "'; update it");
    glGetIntegerv(GL_MAX_SAMPLES, &info.max_samples);
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &info.max_texture_size_px);
    return info;
}

Result<std::unique_ptr<GlContext>> createHeadlessContext() {
    auto context = std::make_unique<HeadlessContext>();
    if (Result<void> opened = context->open(); !opened)
        return tl::unexpected(opened.error());
    return context;
}

void clearWindow(const WindowClear& clear) {
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, clear.width_px, clear.height_px);
    glDisable(GL_SCISSOR_TEST);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glClearColor(clear.red, clear.green, clear.blue, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT);
}

} // namespace lodestone
