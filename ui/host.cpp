#include "ui/host.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <algorithm>
#include <array>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace lodestone::ui {

// Filled by GLFW's callbacks, which find it by the window's user pointer.
struct Host::Events {
    bool any = false;
    std::vector<std::filesystem::path> dropped;

    // A key that goes down and up between two passes would never be seen down: releases wait.
    std::vector<std::array<int, 3>> waiting_releases; // key, scan code, modifiers
    bool pressed = false;                             // any key since the last pass

    void key(GLFWwindow* window, int key, int scan_code, int action, int modifiers) {
        any = true;
        if (action == GLFW_RELEASE && pressed) { // whatever key: Ctrl must outlive the O of Ctrl+O
            waiting_releases.push_back({key, scan_code, modifiers});
            return;
        }
        if (action == GLFW_PRESS)
            pressed = true;
        ImGui_ImplGlfw_KeyCallback(window, key, scan_code, action, modifiers);
    }

    // Not earlier: the pass reads modifiers, too.
    void passEnded(GLFWwindow* window) {
        pressed = false;
        any = any || !waiting_releases.empty();
        for (const auto& [key, scan_code, modifiers] : std::exchange(waiting_releases, {}))
            ImGui_ImplGlfw_KeyCallback(window, key, scan_code, GLFW_RELEASE, modifiers);
    }

    static Events& of(GLFWwindow* window) {
        return *static_cast<Events*>(glfwGetWindowUserPointer(window));
    }
};

namespace {

// LODESTONE_SCALE where it is a sensible number, else 0.
float scaleFromEnvironment() {
    const char* const text = std::getenv("LODESTONE_SCALE");
    const float scale = text ? std::strtof(text, nullptr) : 0.0f;
    return scale >= 0.5f && scale <= 4.0f ? scale : 0.0f;
}

} // namespace

Host::Host(void* window, float scale)
    : window_(static_cast<GLFWwindow*>(window)), events_(std::make_unique<Events>()) {
    glfwSetWindowUserPointer(window_, events_.get());
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.ConfigInputTextCursorBlink = true;
    float display_scale = 1.0f;
    glfwGetWindowContentScale(window_, &display_scale, nullptr);
    int window_width = 1;
    glfwGetWindowSize(window_, &window_width, nullptr);
    density_ = std::max(
        1.0f, static_cast<float>(widthPx()) / static_cast<float>(std::max(1, window_width)));
    if (scale <= 0.0f)
        scale = std::clamp(display_scale / density_, 0.5f, 4.0f);
    if (const float wanted = scaleFromEnvironment(); wanted > 0.0f)
        scale = wanted;
    theme_ = applyTheme(scale, density_);
    ImGui_ImplGlfw_InitForOpenGL(window_, false);
    installCallbacks();
    ImGui_ImplOpenGL3_Init("#version 330 core");
}

void Host::installCallbacks() {
    glfwSetKeyCallback(window_,
                       [](GLFWwindow* w, int key, int scan_code, int action, int modifiers) {
                           Events::of(w).key(w, key, scan_code, action, modifiers);
                       });
    glfwSetCharCallback(window_, [](GLFWwindow* w, unsigned letter) {
        Events::of(w).any = true;
        ImGui_ImplGlfw_CharCallback(w, letter);
    });
    glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int button, int action, int modifiers) {
        Events::of(w).any = true;
        ImGui_ImplGlfw_MouseButtonCallback(w, button, action, modifiers);
    });
    glfwSetScrollCallback(window_, [](GLFWwindow* w, double x, double y) {
        Events::of(w).any = true;
        ImGui_ImplGlfw_ScrollCallback(w, x, y);
    });
    glfwSetCursorEnterCallback(window_, [](GLFWwindow* w, int entered) {
        Events::of(w).any = true;
        ImGui_ImplGlfw_CursorEnterCallback(w, entered);
    });
    glfwSetWindowFocusCallback(window_, [](GLFWwindow* w, int focused) {
        Events::of(w).any = true;
        ImGui_ImplGlfw_WindowFocusCallback(w, focused);
    });
    glfwSetCursorPosCallback(window_,
                             [](GLFWwindow* w, double, double) { Events::of(w).any = true; });
    glfwSetWindowRefreshCallback(window_, [](GLFWwindow* w) { Events::of(w).any = true; });
    glfwSetFramebufferSizeCallback(window_,
                                   [](GLFWwindow* w, int, int) { Events::of(w).any = true; });
    glfwSetWindowCloseCallback(window_, [](GLFWwindow* w) { Events::of(w).any = true; });
    glfwSetDropCallback(window_, [](GLFWwindow* w, int count, const char** paths) {
        Events::of(w).any = true;
        Events::of(w).dropped.assign(paths, paths + count);
    });
}

Host::~Host() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    glfwSetWindowUserPointer(window_, nullptr);
}

bool Host::waitEvents(double wait_s) {
    if (events_->any)
        wait_s = 0.0;
    if (wait_s > 0.0)
        glfwWaitEventsTimeout(wait_s);
    else
        glfwPollEvents();
    return std::exchange(events_->any, false);
}

void Host::beginPass() {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
}

void Host::discardPass() {
    ImGui::EndFrame();
    events_->passEnded(window_);
}

void Host::endFrame() {
    ImGui::Render();
    events_->passEnded(window_);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

std::vector<std::filesystem::path> Host::takeDroppedFiles() {
    return std::exchange(events_->dropped, {});
}

bool Host::takeCloseRequest() {
    const bool wanted = glfwWindowShouldClose(window_) == GLFW_TRUE;
    glfwSetWindowShouldClose(window_, GLFW_FALSE);
    return wanted;
}

void Host::toggleFullScreen() {
    if (glfwGetWindowMonitor(window_)) {
        glfwSetWindowMonitor(window_,
                             nullptr,
                             windowed_.x,
                             windowed_.y,
                             windowed_.width,
                             windowed_.height,
                             GLFW_DONT_CARE);
        return;
    }
    GLFWmonitor* const monitor = glfwGetPrimaryMonitor();
    const GLFWvidmode* const mode = monitor ? glfwGetVideoMode(monitor) : nullptr;
    if (!mode)
        return;
    glfwGetWindowPos(window_, &windowed_.x, &windowed_.y);
    glfwGetWindowSize(window_, &windowed_.width, &windowed_.height);
    glfwSetWindowMonitor(window_, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
}

void Host::setTitle(const std::string& title) {
    if (title == title_)
        return;
    title_ = title;
    glfwSetWindowTitle(window_, title.c_str());
}

int Host::widthPx() const {
    int width = 0;
    glfwGetFramebufferSize(window_, &width, nullptr);
    return width;
}

int Host::heightPx() const {
    int height = 0;
    glfwGetFramebufferSize(window_, nullptr, &height);
    return height;
}

bool Host::minimised() const {
    return glfwGetWindowAttrib(window_, GLFW_ICONIFIED) == GLFW_TRUE || widthPx() < 1 ||
           heightPx() < 1;
}

} // namespace lodestone::ui
