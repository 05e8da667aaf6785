#include "scene/generate.h"
#include "ui/lane_text.h"
#include "ui/panels.h"
#include "ui/widgets.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lodestone::ui {

namespace {

struct SampleWords {
    std::string_view name;
    std::string_view title;
    std::string_view facts;
};

constexpr std::array<SampleWords, 4> kSamples = {{
    {"maple", "Maple tree", "9\u2009324 instances"},
    {"village", "Village", "13\u2009523 instances"},
    {"chair", "Patio chair", "68 instances"},
    {"bunny", "Bunny scan", "70 K triangles"},
}};

bool sampleCard(const Ui& ui, const SampleWords& sample, const ImVec2& size) {
    const ImVec2 begin = ImGui::GetCursorScreenPos();
    const bool pressed = ImGui::InvisibleButton(sample.name.data(), size);
    ui.record(sample.name);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(begin,
                       begin + size,
                       ImGui::IsItemHovered() ? color::kFieldActive : color::kFieldHovered,
                       ui.px(4));
    drawText(ui,
             begin + ImVec2(ui.px(10), ui.px(8)),
             Align::Left,
             sample.title,
             {ui.theme.fonts.semibold});
    drawText(ui,
             begin + ImVec2(ui.px(10), ui.px(27)),
             Align::Left,
             sample.facts,
             {ui.theme.fonts.small, color::kSecondary});
    return pressed;
}

void recentList(const Ui& ui, const Document& document, WindowState& state, float width) {
    constexpr std::size_t kShown = 3;
    const std::size_t count = std::min(kShown, document.recent.size());
    if (count == 0)
        return;
    ImGui::Dummy({0, ui.px(4)});
    sectionTitle(ui, "Recent");
    for (std::size_t at = 0; at < count; ++at) {
        const std::filesystem::path& file = document.recent[at];
        if (linkButton(ui, fitText(ui, file.string(), width))) {
            ui.push(OpenScene{file});
            state.welcome = false;
        }
    }
}

} // namespace

void drawWelcome(Ui ui, const PanelInput& input, WindowState& state, const Area& area) {
    // Where nothing could be opened, it is all there is to see.
    const bool alone = input.document.load_state == LoadState::Empty;
    if (!state.welcome && !alone)
        return;
    ui.panel = "Welcome";
    const float width = std::min(ui.px(640), area.size.x - ui.px(24));
    const float middle_x = area.position.x + area.size.x * 0.5f;
    if (alone)
        ImGui::SetNextWindowPos(
            {middle_x, area.position.y + area.size.y * 0.4f}, ImGuiCond_Always, {0.5f, 0.5f});
    else
        ImGui::SetNextWindowPos(
            {middle_x, area.end().y - ui.px(34)}, ImGuiCond_Always, {0.5f, 1.0f});
    ImGui::SetNextWindowSize({width, 0});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, ui.px(4));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, ui.theme.hairline());
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {ui.px(16), ui.px(14)});
    ImGui::PushStyleColor(ImGuiCol_WindowBg, color::kPopup);
    ImGui::Begin("Welcome",
                 nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize);
    const ImVec2 begin = ImGui::GetCursorScreenPos();
    const float inner = width - ui.px(32);
    drawText(ui, begin, Align::Left, "Welcome to Lodestone", {ui.theme.fonts.semibold});
    drawText(
        ui,
        begin + ImVec2(0, ui.px(20)),
        Align::Left,
        fitText(ui,
                alone ? "Nothing is open. Choose a scene:"
                      : "Drag the slider above the views: every lane follows. Try another scene:",
                inner),
        {nullptr, color::kSecondary});
    ImGui::SetCursorScreenPos(begin + ImVec2(inner - textWidth(ui, "\u00d7"), 0));
    if (!alone && linkButton(ui, "\u00d7", color::kSecondary))
        state.welcome = false;
    ImGui::SetCursorScreenPos(begin + ImVec2(0, ui.px(46)));
    const float spacing = ui.px(8);
    const float card = (inner - 4 * spacing) / 5;
    for (const SampleWords& sample : kSamples) {
        if (sampleCard(ui, sample, {card, ui.px(50)})) {
            ui.push(OpenSample{std::string(sample.name), 1});
            state.welcome = false;
        }
        ImGui::SameLine(0, spacing);
    }
    if (sampleCard(ui, {"Open\u2026", "Your file\u2026", "or drop it here"}, {card, ui.px(50)}))
        openBrowser(input, state);
    recentList(ui, input.document, state, inner);
    ImGui::End();
    ImGui::PopStyleColor();
    ImGui::PopStyleVar(3);
}

} // namespace lodestone::ui
