#pragma once
// Dear ImGui in a GLFW window: context, backends, events. The GL context is somebody else's and
// current. Main thread.
#include "ui/theme.h"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

struct GLFWwindow;

namespace lodestone::ui {

class Host {
public:
    // window: GLFWwindow* with a current OpenGL 3.3 core context; outlives the host.
    // scale: design pixels to window units; 0: the display's own (LODESTONE_SCALE overrides both).
    explicit Host(void* window, float scale = 0.0f);
    ~Host();
    Host(const Host&) = delete;
    Host& operator=(const Host&) = delete;

    const Theme& theme() const { return theme_; }

    // Handles what has happened; sleeps up to wait_s for something to happen (0: does not sleep).
    // Returns whether there was any event.
    bool waitEvents(double wait_s);

    void beginPass();   // before the interface is drawn
    void discardPass(); // the interface is drawn once more before anything is shown
    void endFrame();    // sends the last pass to the window's framebuffer; swapping is the caller's

    std::vector<std::filesystem::path> takeDroppedFiles();
    bool takeCloseRequest();
    void toggleFullScreen();
    void setTitle(const std::string& title);

    int widthPx() const; // framebuffer
    int heightPx() const;

    float density() const { return density_; }

    bool minimised() const;

private:
    struct Events;

    void installCallbacks();

    struct Placement {
        int x = 0;
        int y = 0;
        int width = 0;
        int height = 0;
    };

    GLFWwindow* window_;
    std::unique_ptr<Events> events_;
    Theme theme_;
    float density_ = 1.0f;
    Placement windowed_; // before full screen
    std::string title_;
};

} // namespace lodestone::ui
