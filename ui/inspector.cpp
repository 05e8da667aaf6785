#include "ui/format.h"
#include "ui/lane_text.h"
#include "ui/panels.h"
#include "ui/parameter_control.h"
#include "ui/target_slider.h"
#include "ui/texture_section.h"
#include "ui/widgets.h"

#include <algorithm>
#include <array>

namespace lodestone::ui {

namespace {

void gap(const Ui& ui, float design_px) {
    ImGui::Dummy({0, ui.px(design_px)});
}

void algorithmCombo(const Ui& ui, const Lane& lane) {
    std::vector<std::string> names = {"Original"};
    int selected = 0;
    for (const Algorithm& algorithm : algorithms()) {
        if (lane.settings.algorithm == &algorithm)
            selected = static_cast<int>(names.size());
        names.emplace_back(algorithm.name);
    }
    const std::optional<int> chosen = combo(ui, "Algorithm", names, selected);
    if (lane.settings.algorithm)
        tooltip(ui,
                std::string(lane.settings.algorithm->summary) + "\n" +
                    std::string(lane.settings.algorithm->paper));
    if (!chosen)
        return;
    const auto row = static_cast<std::size_t>(*chosen);
    const std::string_view id = row == 0 ? std::string_view() : algorithms()[row - 1].id;
    ui.push(SetLaneAlgorithm{lane.id, std::string(id)});
}

void targetKind(const Ui& ui, const Document& document, const Lane& lane) {
    constexpr std::array<std::string_view, 5> kKinds = {"%", "tri", "size", "error", "px"};
    constexpr std::array<std::string_view, 5> kTips = {
        "Target as a share of the original's triangles.",
        "Target as a number of triangles, instances counted.",
        "Target as the size of the exported file.",
        "Target as the estimated error in % of the scene's diagonal.",
        "Target as the estimated error in pixels of a view; it follows the camera."};
    const int selected = lane.settings.error_px ? 4 : static_cast<int>(lane.settings.target.kind);
    const float width = ImGui::GetContentRegionAvail().x;
    const auto chosen = segmented(ui, {"Target kind", kKinds, selected, kTips, width});
    if (chosen == 4)
        ui.push(SetLanePixels{lane.id, shownPixels(document, lane)});
    else if (chosen)
        ui.push(SetLaneTarget{lane.id, sameTarget(lane, static_cast<Target::Kind>(*chosen))});
}

void orderingControl(const Ui& ui, const Lane& lane) {
    constexpr std::array<std::string_view, 3> kOrderings = {"triangle", "byte", "cost"};
    constexpr std::array<std::string_view, 3> kTips = {
        "Next comes the collapse that costs least for each instanced triangle it removes.",
        "Next comes the collapse that costs least for each byte it saves.",
        "Next comes the collapse that costs least: the paper's order."};
    const ImVec2 begin = ImGui::GetCursorScreenPos();
    drawText(ui, begin, Align::Left, "Ordering", {nullptr, color::kSecondary});
    ImGui::Dummy({0, ImGui::GetTextLineHeight() + ui.px(2)});
    const float width = ImGui::GetContentRegionAvail().x;
    const auto selected = static_cast<int>(lane.settings.ordering);
    if (const auto chosen = segmented(ui, {"Ordering", kOrderings, selected, kTips, width}))
        ui.push(SetOrdering{lane.id, static_cast<Ordering>(*chosen)});
}

void laneFacts(const Ui& ui, const Document& document, const Lane& lane) {
    const LaneNumbers& numbers = lane.status.numbers;
    if (!lane.status.lod)
        return;
    labelledValue(ui, "Triangles", formatCount(numbers.triangles));
    labelledValue(ui, "Unique triangles", formatCount(numbers.unique_triangles));
    labelledValue(ui,
                  "Instances",
                  formatCount(numbers.instances),
                  "of " + formatCount(document.counts.instances));
    if (lane.settings.algorithm)
        labelledValue(ui, "Estimated error", formatError(numbers.error_estimate) + " %");
}

void followToggle(const Ui& ui, const Lane& lane) {
    bool follows = lane.settings.follows_master;
    if (toggle(ui, "Follow all lanes", follows))
        ui.push(FollowMaster{lane.id, follows});
    tooltip(ui, "The slider above the views moves this lane too.");
}

void drawLane(const Ui& ui, const PanelInput& input, WindowState& state, const Lane& lane) {
    sectionTitle(ui, "Lane \u00b7 " + std::string(laneName(lane.settings)));
    algorithmCombo(ui, lane);
    gap(ui, 1);
    if (lane.settings.algorithm) {
        laneTargetSlider(ui, input, state, lane, 0.0f);
        targetKind(ui, input.document, lane);
        gap(ui, 0);
        followToggle(ui, lane);
        if (lane.settings.algorithm->family == Family::EdgeCollapse)
            orderingControl(ui, lane);
        drawTextureSection(ui, input, state, lane);
        for (const ParameterInfo& parameter : lane.settings.algorithm->parameters)
            if (!parameter.of_textures)
                parameterControl(ui, lane, parameter);
        gap(ui, 1);
    }
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {ui.px(8), ui.px(4)});
    laneFacts(ui, input.document, lane);
    ImGui::PopStyleVar();
}

constexpr std::array kInstancings = {
    Instancing::Auto, Instancing::Gpu, Instancing::Nodes, Instancing::Expand};

void drawExport(const Ui& ui, const PanelInput& input, WindowState& state, const Lane* lane) {
    const Document& document = input.document;
    sectionTitle(ui, "Export");
    std::vector<std::string> names;
    int selected = 0;
    for (const Instancing instancing : kInstancings) {
        if (document.export_options.instancing == instancing)
            selected = static_cast<int>(names.size());
        names.push_back("GLB \u00b7 " + std::string(instancingName(instancing)));
    }
    if (const auto chosen = combo(ui, "Format", names, selected)) {
        ExportOptions options = document.export_options;
        options.instancing = kInstancings[static_cast<std::size_t>(*chosen)];
        ui.push(SetExportOptions{options});
    }
    tooltip(ui,
            "How instances are written: as EXT_mesh_gpu_instancing, as nodes, whichever is "
            "smaller, or expanded into plain triangles.");
    const bool ready = lane && lane->status.lod;
    const Lane* original = nullptr;
    for (const Lane& other : document.lanes)
        if (!other.settings.algorithm && other.status.lod)
            original = &other;
    const std::uint64_t size_bytes = ready ? lane->status.numbers.predicted_bytes : 0;
    gap(ui, 0);
    const bool estimated =
        isEstimated(document.export_options) || (ready && lane->status.numbers.bytes_estimated);
    labelledValue(ui,
                  "Size",
                  ready ? (estimated ? "~" : "") + formatBytes(size_bytes) : kUnknown,
                  ready && !estimated ? "exact" : "");
    labelledValue(ui,
                  "vs. original",
                  ready && original
                      ? formatChange(static_cast<double>(original->status.numbers.predicted_bytes),
                                     static_cast<double>(size_bytes))
                      : std::string(kUnknown));
    gap(ui, 1);
    ImGui::BeginDisabled(!ready);
    if (primaryButton(ui, "Export LOD\u2026", ImGui::GetContentRegionAvail().x))
        openExportDialog(input, state);
    ImGui::EndDisabled();
}

} // namespace

void drawInspector(Ui ui, const PanelInput& input, WindowState& state, const Area& area) {
    ui.panel = "Inspector";
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
    beginPanel("Inspector", area.position, area.size, PanelScroll::None);
    const float margin = ui.px(12);
    const float export_height = ui.px(176);
    const ImVec2 inner{area.size.x - 2 * margin, area.size.y - export_height - margin};
    const Lane* const lane = input.document.findLane(input.document.active_lane);
    ImGui::SetCursorScreenPos(area.position + ImVec2(margin, ui.px(10)));
    // The scroll bar stands in the margin, so that both halves of the panel share one right edge.
    ImGui::SetNextWindowContentSize({inner.x, 0});
    ImGui::BeginChild("lane", {inner.x + ui.px(11), std::max(1.0f, inner.y)});
    if (lane) {
        drawLane(ui, input, state, *lane);
    } else {
        sectionTitle(ui, "Lane");
        ImGui::TextDisabled("Click a view to choose its lane.");
    }
    fadeWhereMore(ui, color::kPanel);
    ImGui::EndChild();
    const float top = area.end().y - export_height;
    horizontalHairline(ui, area.position.x, area.end().x, top);
    ImGui::SetCursorScreenPos({area.position.x + margin, top + ui.px(10)});
    ImGui::BeginChild(
        "export", {inner.x, export_height - ui.px(12)}, false, ImGuiWindowFlags_NoScrollbar);
    drawExport(ui, input, state, lane);
    ImGui::EndChild();
    verticalHairline(ui, area.position.x, area.position.y, area.end().y);
    endPanel();
    ImGui::PopStyleVar();
}

} // namespace lodestone::ui
