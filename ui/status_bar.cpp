#include "ui/format.h"
#include "ui/lane_text.h"
#include "ui/panels.h"
#include "ui/widgets.h"

#include <algorithm>
#include <cmath>

namespace lodestone::ui {

namespace {

constexpr double kToastTimeSeconds = 6.0; // errors stay until they are closed

// The job that has been running longest, or nullptr.
const JobStatus* shownJob(const Document& document) {
    const JobStatus* shown = nullptr;
    for (const JobStatus& job : document.jobs)
        if (job.running && (!shown || job.elapsed_s > shown->elapsed_s))
            shown = &job;
    return shown;
}

void drawJob(const Ui& ui, const Document& document, const JobStatus& job, float y, float x) {
    const auto put = [&](std::string_view text, ImU32 ink) {
        drawText(ui, {x, y}, Align::Left, text, {nullptr, ink});
        x += textWidth(ui, text) + ui.px(16);
    };
    std::string words = job.label + " " + std::to_string(std::lround(job.progress * 100.0)) + " %";
    if (document.jobs.size() > 1)
        words += " \u00b7 " + std::to_string(document.jobs.size() - 1) + " more";
    put(words, color::kSecondary);
    const Lane* const lane = document.findLane(job.lane);
    progressLine(ui,
                 {x, y + ui.px(6)},
                 ui.px(140),
                 job.progress,
                 lane ? packed(lane->settings.colour) : color::kAccent);
    x += ui.px(156);
    constexpr double kTellsSomething = 0.5;
    if (job.remaining_s && *job.remaining_s >= kTellsSomething)
        put(formatSeconds(*job.remaining_s) + " left", color::kSecondary);
    ImGui::SetCursorScreenPos({x, y});
    if (linkButton(ui, "Cancel"))
        ui.push(CancelJob{job.id});
}

ImU32 inkOf(Severity severity) {
    return severity == Severity::Error     ? color::kError
           : severity == Severity::Warning ? color::kWarning
                                           : color::kSecondary;
}

std::string wordsOf(const Message& message) {
    return message.count > 1 ? message.text + " (\u00d7 " + std::to_string(message.count) + ")"
                             : message.text;
}

// Every message, the worst and then newest first.
void messageList(Ui ui, const Document& document) {
    ui.panel = "Messages";
    std::vector<const Message*> ranked;
    for (const Message& message : document.messages)
        ranked.push_back(&message);
    std::ranges::sort(ranked, std::ranges::greater(), [](const Message* message) {
        return std::pair(message->severity, message->sequence);
    });
    const float width = ui.px(560);
    const float rows = std::min(10.0f, static_cast<float>(ranked.size()));
    ImGui::BeginChild("list", {width, rows * ui.px(22)});
    for (const Message* const message : ranked) {
        const ImVec2 at = ImGui::GetCursorScreenPos();
        ImGui::GetWindowDrawList()->AddCircleFilled(
            at + ImVec2(ui.px(4), ui.px(8)), ui.px(4), inkOf(message->severity), 20);
        const std::string words = wordsOf(*message);
        drawText(ui, at + ImVec2(ui.px(16), 0), Align::Left, fitText(ui, words, width - ui.px(32)));
        ImGui::Dummy({width - ui.px(16), ui.px(16)});
        tooltip(ui, words);
    }
    ImGui::EndChild();
    if (linkButton(ui, "Clear", color::kAccent)) {
        ui.push(ClearMessages{});
        ImGui::CloseCurrentPopup();
    }
    closeOnEscape();
}

// The worst message; a click lists all.
void drawMessage(const Ui& ui, const Document& document, float y, float x, float width) {
    const Message* const message = topMessage(document);
    if (!message)
        return;
    std::string text = wordsOf(*message);
    if (document.messages.size() > 1)
        text += " \u00b7 " + std::to_string(document.messages.size() - 1) + " more";
    drawText(
        ui, {x, y}, Align::Left, fitText(ui, text, width), {nullptr, inkOf(message->severity)});
    ImGui::SetCursorScreenPos({x, y});
    if (ImGui::InvisibleButton("message", {std::max(1.0f, width), ImGui::GetTextLineHeight()}))
        ImGui::OpenPopup("messages");
    ui.record("message");
    tooltip(ui, text + "\nClick for all messages.");
    ImGui::SetNextWindowPos({x, y - ui.px(8)}, ImGuiCond_Always, {0, 1});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {ui.px(12), ui.px(10)});
    if (ImGui::BeginPopup("messages")) {
        messageList(ui, document);
        ImGui::EndPopup();
    }
    ImGui::PopStyleVar();
}

// What the next drag or the running animation does; empty: nothing out of the ordinary.
std::string modeWords(const Document& document, const WindowState& state) {
    if (const Lane* const lane = document.findLane(state.animation.lane))
        return "Animating " + std::string(laneName(lane->settings)) + " \u00b7 A stops it";
    return state.drag_moves_light ? "Left drag moves the light \u00b7 0: the camera" : "";
}

} // namespace

void drawStatusBar(Ui ui, const PanelInput& input, WindowState& state, const Area& area) {
    ui.panel = "Status";
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
    beginPanel("Status", area.position, area.size, PanelScroll::None);
    const Document& document = input.document;
    const float y = area.position.y + (area.size.y - ImGui::GetTextLineHeight()) * 0.5f;
    const std::string machine = input.facts.renderer + " \u00b7 " +
                                std::to_string(input.facts.width_px) + "\u00d7" +
                                std::to_string(input.facts.height_px);
    const float right = area.end().x - ui.px(12);
    drawText(ui, {right, y}, Align::Right, machine, {nullptr, color::kSecondary});
    float left_end = right - textWidth(ui, machine) - ui.px(24);
    if (document.scene) {
        const std::string scene = sceneTitle(document) + " \u00b7 " +
                                  formatCount(document.counts.instances) +
                                  (document.counts.instances == 1 ? " instance" : " instances");
        drawText(ui, {left_end, y}, Align::Right, scene, {nullptr, color::kSecondary});
        left_end -= textWidth(ui, scene) + ui.px(24);
    }
    const float left = area.position.x + ui.px(12);
    if (const JobStatus* const job = shownJob(document)) {
        drawJob(ui, document, *job, y, left);
        state.animate();
    } else if (const std::string mode = modeWords(document, state); !mode.empty()) {
        drawText(ui, {left, y}, Align::Left, mode, {nullptr, color::kAccent});
    } else {
        drawMessage(ui, document, y, left, left_end - left);
    }
    horizontalHairline(ui, area.position.x, area.end().x, area.position.y);
    endPanel();
    ImGui::PopStyleVar(2);
}

void drawToast(Ui ui, const PanelInput& input, WindowState& state, const Area& area) {
    ui.panel = "Toast";
    const std::vector<Message>& messages = input.document.messages;
    if (messages.empty() || messages.back().sequence <= state.seen_message)
        return;
    const Message& message = messages.back();
    if (message.sequence != state.toast_message) {
        state.toast_message = message.sequence;
        state.toast_begin_s = ImGui::GetTime();
    }
    const bool stays = message.severity == Severity::Error;
    const double left_s = state.toast_begin_s + kToastTimeSeconds - ImGui::GetTime();
    if (!stays && left_s <= 0.0) {
        state.seen_message = message.sequence;
        return;
    }
    if (!stays)
        state.wakeIn(left_s + 0.02);
    const float width = std::min(ui.px(460), area.size.x - ui.px(24));
    const float text_width = width - ui.px(64);
    const ImVec2 text_size = ImGui::CalcTextSize(message.text.c_str(), nullptr, false, text_width);
    const ImVec2 size{width, text_size.y + ui.px(20)};
    ImGui::SetNextWindowPos(
        {area.position.x + (area.size.x - width) * 0.5f, area.end().y - size.y - ui.px(44)});
    ImGui::SetNextWindowSize(size);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, ui.px(4));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 1);
    ImGui::PushStyleColor(ImGuiCol_WindowBg, color::kPopup);
    ImGui::Begin("Toast",
                 nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                     ImGuiWindowFlags_NoNav);
    const ImVec2 begin = ImGui::GetWindowPos();
    const ImU32 mark = stays                                   ? color::kError
                       : message.severity == Severity::Warning ? color::kWarning
                                                               : color::kAccent;
    ImGui::GetWindowDrawList()->AddCircleFilled(
        begin + ImVec2(ui.px(16), size.y * 0.5f), ui.px(4), mark, 24);
    ImGui::SetCursorScreenPos(begin + ImVec2(ui.px(32), ui.px(10)));
    ImGui::PushTextWrapPos(ui.px(32) + text_width);
    ImGui::TextUnformatted(message.text.c_str());
    ImGui::PopTextWrapPos();
    ui.record(stays ? "error" : "message");
    ImGui::SetCursorScreenPos(
        begin + ImVec2(width - ui.px(24), (size.y - ImGui::GetTextLineHeight()) * 0.5f));
    if (linkButton(ui, "\u00d7", color::kSecondary))
        state.seen_message = message.sequence;
    ImGui::End();
    ImGui::PopStyleColor();
    ImGui::PopStyleVar(2);
}

} // namespace lodestone::ui
