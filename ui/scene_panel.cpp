#include "ui/format.h"
#include "ui/lane_text.h"
#include "ui/panels.h"
#include "ui/widgets.h"

#include <algorithm>
#include <cmath>

namespace lodestone::ui {

namespace {

constexpr float kRowHeight = 22.0f;

std::uint64_t trianglesOf(const LodSubmesh& submesh) {
    std::uint64_t count = 0;
    for (const GeometryPtr& geometry : submesh.primitives)
        count += geometry->triangleCount();
    return count;
}

// Triangles of a submesh in the lane's LOD; of the original where the lane dissolved submeshes.
std::uint64_t shownTriangles(const Document& document, const Lane* lane, std::uint32_t submesh) {
    const bool same_scene = lane && lane->status.lod && lane->status.scene == document.scene;
    if (same_scene && submesh < lane->status.lod->submeshes.size())
        return trianglesOf(lane->status.lod->submeshes[submesh]);
    return triangleCount(document.scene->submeshes[submesh]);
}

bool isSelected(const Document& document, std::uint32_t submesh) {
    return std::any_of(document.selection.begin(),
                       document.selection.end(),
                       [&](const SelectedItem& item) { return item.submesh == submesh; });
}

bool isLocked(const Document& document, std::uint32_t submesh) {
    return submesh < document.locked.size() && document.locked[submesh];
}

// Right: a ring, filled when the submesh is locked.
void drawLock(const Ui& ui, const Document& document, std::uint32_t submesh, const ImVec2& center) {
    const float reach = ui.px(9);
    ImGui::SetCursorScreenPos(center - ImVec2(reach, reach));
    const bool locked = isLocked(document, submesh);
    if (ImGui::InvisibleButton("lock", {2 * reach, 2 * reach}))
        ui.push(SetLocked{{submesh}, !locked});
    ui.record("lock " + std::to_string(submesh));
    const ImU32 ink = ImGui::IsItemHovered() ? color::kText : locked ? color::kText : color::kFaint;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    if (locked)
        list.AddCircleFilled(center, ui.px(4), ink, 20);
    list.AddCircle(center, ui.px(4), ink, 20, std::max(1.0f, ui.px(1.2f)));
    tooltip(ui,
            locked ? "Locked: never simplified. Click to unlock."
                   : "Click to lock: this submesh keeps every triangle.");
}

struct RowColumns {
    float name_x;
    float instances_right;
    float triangles_right;
    float bar_x;
    float lock_x;
};

RowColumns rowColumns(const Ui& ui, float left, float width) {
    const float right = left + width;
    return {left + ui.px(12),
            left + ui.px(116),
            left + ui.px(158),
            left + ui.px(163),
            right - ui.px(16)};
}

void drawRow(const Ui& ui,
             const PanelInput& input,
             std::uint32_t submesh,
             std::uint32_t instances,
             float width) {
    const Document& document = input.document;
    const Submesh& item = document.scene->submeshes[submesh];
    const ImVec2 begin = ImGui::GetCursorScreenPos();
    const float height = ui.px(kRowHeight);
    ImGui::PushID(static_cast<int>(submesh));
    const RowColumns at = rowColumns(ui, begin.x, width);
    if (ImGui::InvisibleButton("row", {at.lock_x - ui.px(9) - begin.x, height})) {
        const auto mode = ImGui::GetIO().KeyShift || ImGui::GetIO().KeyCtrl ? Select::Mode::Toggle
                                                                            : Select::Mode::Replace;
        ui.push(Select{{SelectedItem{submesh}}, mode});
    }
    ui.record("submesh " + std::to_string(submesh));
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 end{begin.x + width, begin.y + height};
    if (isSelected(document, submesh))
        list.AddRectFilled(begin, end, color::kSelection);
    else if (ImGui::IsItemHovered())
        list.AddRectFilled(begin, end, color::kField);
    const float y = begin.y + (height - ImGui::GetTextLineHeight()) * 0.5f;
    const std::uint64_t before = triangleCount(item);
    const std::uint64_t now =
        shownTriangles(document, document.findLane(document.active_lane), submesh);
    const std::string triangles = now < 10'000 ? formatCount(now) : formatShortCount(now);
    const std::string count = "\u00d7 " + formatCount(instances);
    ImFont* const small = ui.theme.fonts.small;
    const float count_right =
        std::min(at.instances_right, at.triangles_right - textWidth(ui, triangles) - ui.px(8));
    const float name_width = count_right - textWidth(ui, count, small) - ui.px(6) - at.name_x;
    const std::string name = item.name.empty() ? "mesh " + std::to_string(submesh + 1) : item.name;
    drawText(ui, {at.name_x, y}, Align::Left, fitText(ui, name, name_width));
    tooltip(ui, name);
    drawText(ui, {count_right, y + ui.px(2)}, Align::Right, count, {small, color::kSecondary});
    drawText(ui, {at.triangles_right, y}, Align::Right, triangles);
    const float bar_width = at.lock_x - ui.px(12) - at.bar_x;
    const double kept = before > 0 ? static_cast<double>(now) / static_cast<double>(before) : 0.0;
    progressLine(
        ui, {at.bar_x, begin.y + height * 0.5f - ui.px(2)}, bar_width, kept, color::kAccent);
    drawLock(ui, document, submesh, {at.lock_x, begin.y + height * 0.5f});
    ImGui::PopID();
    ImGui::SetCursorScreenPos({begin.x, end.y});
}

// Heaviest first: triangles of all instances; equals in the order of the file.
void updateOrder(const ScenePtr& scene, SubmeshOrder& order) {
    if (order.scene == scene)
        return;
    order.ranges = instanceRanges(*scene);
    std::vector<std::uint64_t> weights(order.ranges.size());
    order.scene = scene;
    order.submeshes.resize(order.ranges.size());
    for (std::uint32_t at = 0; at < order.ranges.size(); ++at) {
        weights[at] = triangleCount(scene->submeshes[at]) * order.ranges[at].size();
        order.submeshes[at] = at;
    }
    std::ranges::stable_sort(
        order.submeshes, [&](std::uint32_t a, std::uint32_t b) { return weights[a] > weights[b]; });
}

// What was selected in a view is scrolled into the list.
void revealSelection(const Ui& ui, const Document& document, SubmeshOrder& order) {
    if (document.selection.empty() || document.selection.front() == order.revealed)
        return;
    order.revealed = document.selection.front();
    const auto row = std::ranges::find(order.submeshes, order.revealed.submesh);
    const float y = ui.px(kRowHeight) * static_cast<float>(row - order.submeshes.begin());
    const float height = ImGui::GetWindowHeight();
    if (y < ImGui::GetScrollY() || y + 2 * ui.px(kRowHeight) > ImGui::GetScrollY() + height)
        ImGui::SetScrollY(std::max(0.0f, y - height * 0.5f));
}

void drawList(const Ui& ui, const PanelInput& input, SubmeshOrder& order, float width) {
    revealSelection(ui, input.document, order);
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {0, 0});
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(order.submeshes.size()), ui.px(kRowHeight));
    while (clipper.Step())
        for (int row = clipper.DisplayStart; row < clipper.DisplayEnd; ++row) {
            const std::uint32_t submesh = order.submeshes[static_cast<std::size_t>(row)];
            drawRow(ui, input, submesh, order.ranges[submesh].size(), width);
        }
    ImGui::PopStyleVar();
}

struct SelectionSummary {
    std::vector<std::uint32_t> submeshes;
    std::uint64_t instances = 0;
    std::uint64_t before = 0;
    std::uint64_t now = 0;
};

SelectionSummary summarise(const Document& document, std::span<const InstanceRange> ranges) {
    SelectionSummary summary;
    const Lane* const active = document.findLane(document.active_lane);
    for (const SelectedItem& item : document.selection) {
        if (item.submesh >= ranges.size() ||
            (!summary.submeshes.empty() && summary.submeshes.back() == item.submesh))
            continue;
        summary.submeshes.push_back(item.submesh);
        summary.instances += ranges[item.submesh].size();
        summary.before += triangleCount(document.scene->submeshes[item.submesh]);
        summary.now += shownTriangles(document, active, item.submesh);
    }
    return summary;
}

// "1 of 1 020 instances" where single ones are selected.
std::string instanceWords(const Document& document, const SelectionSummary& summary) {
    const auto single = std::ranges::count_if(
        document.selection, [](const SelectedItem& item) { return item.instance != kNone; });
    const std::string all = formatCount(summary.instances) + " instances";
    return single > 0 && static_cast<std::size_t>(single) == document.selection.size()
               ? formatCount(static_cast<std::uint64_t>(single)) + " of " + all
               : all;
}

void importanceSlider(const Ui& ui, const Document& document, const SelectionSummary& summary) {
    const std::uint32_t first = summary.submeshes.front();
    const double importance = first < document.importance.size() ? document.importance[first] : 1.0;
    char text[16] = "";
    std::snprintf(text, sizeof text, importance < 1.0 ? "%.2f \u00d7" : "%.1f \u00d7", importance);
    SliderSpec spec;
    spec.label = "Importance";
    spec.value = text;
    spec.fraction = std::log10(importance) * 0.5 + 0.5;
    spec.tooltip = "How dear this submesh's detail is, 0.1 to 10 times. Double, and its edges "
                   "collapse as late as if they cost twice as much.";
    const SliderEvent event = slider(ui, spec);
    if (event.fraction) {
        double wanted = std::pow(10.0, *event.fraction * 2.0 - 1.0);
        if (std::abs(*event.fraction - 0.5) < 0.02)
            wanted = 1.0; // the middle catches
        ui.push(SetImportance{summary.submeshes, wanted, event.drag});
    }
    if (event.released)
        ui.push(EndDrag{});
}

void drawSelection(const Ui& ui, const PanelInput& input, const SubmeshOrder& order) {
    const Document& document = input.document;
    const SelectionSummary summary = summarise(document, order.ranges);
    sectionTitle(ui, "Selection");
    if (summary.submeshes.empty()) {
        ImGui::PushStyleColor(ImGuiCol_Text, color::kSecondary);
        ImGui::TextWrapped("Click a submesh, here or in a view.");
        ImGui::PopStyleColor();
        return;
    }
    const std::string name = summary.submeshes.size() == 1
                                 ? document.scene->submeshes[summary.submeshes.front()].name
                                 : formatCount(summary.submeshes.size()) + " submeshes";
    const float width = ImGui::GetContentRegionAvail().x;
    const std::string first =
        fitText(ui, name + " \u00b7 " + instanceWords(document, summary), width);
    ImGui::TextDisabled("%s", first.c_str());
    ImGui::TextDisabled("%s \u2192 %s triangles",
                        formatCount(summary.before).c_str(),
                        formatCount(summary.now).c_str());
    ImGui::Dummy({0, ui.px(2)});
    importanceSlider(ui, document, summary);
}

} // namespace

void drawScenePanel(Ui ui, const PanelInput& input, WindowState& state, const Area& area) {
    ui.panel = "Scene";
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
    beginPanel("Scene", area.position, area.size, PanelScroll::None);
    ImGui::SetCursorScreenPos(area.position + ImVec2(ui.px(12), ui.px(10)));
    const Document& document = input.document;
    const std::size_t count = document.scene ? document.scene->submeshes.size() : 0;
    sectionTitle(ui,
                 document.scene ? "Scene \u00b7 " + formatCount(count) +
                                      (count == 1 ? " submesh" : " submeshes")
                                : std::string("Scene"));
    if (document.scene) {
        const float selection_height = ui.px(document.selection.empty() ? 78.0f : 138.0f);
        const float list_top = area.position.y + ui.px(34);
        const float list_height =
            std::min(static_cast<float>(count) * ui.px(kRowHeight),
                     std::max(ui.px(kRowHeight), area.end().y - list_top - selection_height));
        updateOrder(document.scene, state.submesh_order);
        ImGui::SetCursorScreenPos({area.position.x, list_top});
        ImGui::BeginChild("list", {area.size.x, list_height});
        drawList(ui, input, state.submesh_order, area.size.x - ui.theme.hairline());
        fadeWhereMore(ui, color::kPanel);
        ImGui::EndChild();
        const ImVec2 below{area.position.x + ui.px(12), list_top + list_height + ui.px(16)};
        ImGui::SetCursorScreenPos(below);
        ImGui::BeginChild("selection", {area.size.x - ui.px(24), area.end().y - below.y});
        drawSelection(ui, input, state.submesh_order);
        ImGui::EndChild();
    }
    verticalHairline(ui, area.end().x - ui.theme.hairline(), area.position.y, area.end().y);
    endPanel();
    ImGui::PopStyleVar();
}

} // namespace lodestone::ui
