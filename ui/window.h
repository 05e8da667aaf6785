#pragma once
// The whole window: lays out the panels, keeps what they remember. Knows neither GL nor GLFW.
#include "app/session.h"
#include "ui/window_state.h"

namespace lodestone::ui {

class Window {
public:
    struct Options {
        bool welcome = false; // shows the overlay of the first run
    };

    Window(Session& session, const Theme& theme, const Options& options);

    // One pass of the interface, between NewFrame and Render: reads the document, fills commands.
    // Cheap enough to run twice a frame, so that numbers and pictures agree. Main thread.
    void
    draw(const WindowFacts& facts, std::span<const LanePicture> pictures, CommandQueue& commands);

    // Pictures that the last pass had room for.
    std::span<const ViewRequest> views() const { return state_.views; }

    // Seconds until something looks different without any input.
    double wakeIn() const { return state_.wake_in_s; }

    // The user has answered that the program should end.
    bool wantsToQuit() const { return state_.quit; }

    // True once after each request to enter or leave full screen.
    bool takeFullScreenToggle() { return std::exchange(state_.full_screen_toggled, false); }

    // The close button was pressed: asks.
    void askToQuit() { state_.open(Dialog::Quit); }

    // Files dropped on the window: the first one is opened.
    void drop(std::span<const std::filesystem::path> files, CommandQueue& commands);

private:
    Session& session_;
    Theme theme_;
    WindowState state_;
    WidgetState widgets_;
};

} // namespace lodestone::ui
