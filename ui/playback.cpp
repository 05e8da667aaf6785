#include "ui/format.h"
#include "ui/panels.h"
#include "ui/widgets.h"

#include <algorithm>
#include <cmath>

namespace lodestone::ui {

namespace {

constexpr double kLongestStepSeconds = 0.1; // a slow frame does not skip more

std::string animationTitle(const Rig& rig, std::uint32_t animation) {
    const std::string& name = rig.animations[animation].name;
    return name.empty() ? "Animation " + std::to_string(animation + 1) : name;
}

void setMoment(const Ui& ui, const DisplayOptions& view, const Moment& moment) {
    if (moment == view.moment)
        return;
    DisplayOptions next = view;
    next.moment = moment;
    ui.push(SetView{next});
}

// Another scene is at rest and known by its own animations.
void follow(const Ui& ui, const Document& document, Playback& playback) {
    if (playback.scene == document.scene)
        return;
    playback = {document.scene, document.scene ? readRig(*document.scene) : nullptr, false};
    setMoment(ui, document.view, {});
}

void advance(const Ui& ui, const DisplayOptions& view, WindowState& state) {
    const Playback& playback = state.playback;
    if (!playback.playing)
        return;
    Moment moment = view.moment;
    if (moment.animation >= playback.rig->animations.size())
        moment = {0, 0.0};
    const double duration = playback.rig->animations[moment.animation].duration_s;
    const double step =
        std::min(static_cast<double>(ImGui::GetIO().DeltaTime), kLongestStepSeconds);
    moment.time_s = duration > 0.0 ? std::fmod(moment.time_s + step, duration) : 0.0;
    setMoment(ui, view, moment);
    state.animate();
}

bool playButton(const Ui& ui, bool playing, float side) {
    const ImVec2 min = ImGui::GetCursorScreenPos();
    const bool clicked = ImGui::InvisibleButton("play", {side, side});
    ui.record("play");
    tooltip(ui, playing ? "Stop the animation (P)." : "Play the animation (P).");
    const ImU32 colour = ImGui::IsItemHovered() ? color::kAccentHovered : color::kAccent;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 middle = min + ImVec2(side * 0.5f, side * 0.5f);
    const float reach = ui.px(6);
    if (playing) {
        for (const float x : {-0.55f, 0.55f})
            list.AddRectFilled(middle + ImVec2(reach * (x - 0.25f), -reach),
                               middle + ImVec2(reach * (x + 0.25f), reach),
                               colour);
    } else {
        list.AddTriangleFilled(middle + ImVec2(-reach * 0.7f, -reach),
                               middle + ImVec2(reach, 0.0f),
                               middle + ImVec2(-reach * 0.7f, reach),
                               colour);
    }
    return clicked;
}

// The name; a click takes the next animation, after the last one the rest pose.
void animationName(const Ui& ui, const DisplayOptions& view, const Rig& rig, float width) {
    const bool at_rest = view.moment.animation >= rig.animations.size();
    const std::string title =
        at_rest ? std::string("At rest") : animationTitle(rig, view.moment.animation);
    if (linkButton(ui, fitText(ui, title, width))) {
        const std::uint32_t next = at_rest ? 0 : view.moment.animation + 1;
        setMoment(ui, view, next < rig.animations.size() ? Moment{next, 0.0} : Moment{});
    }
    ui.record("animation");
    tooltip(ui, "The next animation of the file, and the pose at rest after the last one.");
}

void timeSlider(const Ui& ui, const DisplayOptions& view, WindowState& state, float width) {
    const Rig& rig = *state.playback.rig;
    const std::uint32_t animation =
        view.moment.animation < rig.animations.size() ? view.moment.animation : 0;
    const double duration = rig.animations[animation].duration_s;
    SliderSpec spec;
    spec.label = "time";
    spec.tooltip = "The moment of the animation that all views show.";
    spec.fraction = duration > 0.0 ? std::clamp(view.moment.time_s / duration, 0.0, 1.0) : 0.0;
    spec.enabled = duration > 0.0;
    if (const SliderEvent event = sliderTrack(ui, spec, width); event.fraction) {
        state.playback.playing = false;
        setMoment(ui, view, {animation, *event.fraction * duration});
    }
}

} // namespace

void drawPlayback(Ui ui, const PanelInput& input, WindowState& state, const Area& area) {
    ui.panel = "Playback";
    const Document& document = input.document;
    follow(ui, document, state.playback);
    if (!document.scene || state.playback.rig->animations.empty())
        return;
    advance(ui, document.view, state);
    const ImVec2 size{std::min(ui.px(420), area.size.x - ui.px(24)), ui.px(30)};
    ImGui::SetNextWindowPos(
        {area.position.x + (area.size.x - size.x) * 0.5f, area.end().y - size.y - ui.px(36)});
    ImGui::SetNextWindowSize(size);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, ui.px(4));
    ImGui::PushStyleColor(ImGuiCol_WindowBg, color::kPopup);
    ImGui::Begin("Playback",
                 nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                     ImGuiWindowFlags_NoNav);
    const ImVec2 begin = ImGui::GetWindowPos();
    const float text_y = begin.y + (size.y - ImGui::GetTextLineHeight()) * 0.5f;
    ImGui::SetCursorScreenPos(begin);
    if (playButton(ui, state.playback.playing, size.y))
        state.playback.playing = !state.playback.playing;
    ImGui::SetCursorScreenPos({begin.x + size.y + ui.px(4), text_y});
    animationName(ui, document.view, *state.playback.rig, ui.px(110));
    const std::string time = formatSeconds(document.view.moment.time_s);
    const float track = begin.x + size.y + ui.px(126);
    ImGui::SetCursorScreenPos({track, begin.y + ui.px(7)});
    timeSlider(ui, document.view, state, begin.x + size.x - ui.px(68) - track);
    drawText(ui, {begin.x + size.x - ui.px(12), text_y}, Align::Right, time);
    ImGui::End();
    ImGui::PopStyleColor();
    ImGui::PopStyleVar(3);
}

} // namespace lodestone::ui
