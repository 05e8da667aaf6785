#include "ui/display_menu.h"

#include "ui/widgets.h"

#include <array>

namespace lodestone::ui {

namespace {

struct ShadingItem {
    ShadingMode mode;
    std::string_view title;
    const char* key;
    std::string_view tooltip;
};

constexpr std::array<ShadingItem, kShadingModes> kShadings = {{
    {ShadingMode::Lit, "Lit", nullptr, "Materials as the file has them."},
    {ShadingMode::Clay, "Clay", nullptr, "One soft grey material, lit by the key light."},
    {ShadingMode::Matcap, "Matcap", nullptr, "A studio that turns with the camera, for shape."},
    {ShadingMode::Flat, "Flat", nullptr, "Every triangle by itself: edges of the mesh show."},
    {ShadingMode::Normals, "Normals", "N", "The direction of the surface as colour."},
    {ShadingMode::UvChecker, "UV checker", nullptr, "A checker board on the texture coordinates."},
    {ShadingMode::Submesh, "By submesh", nullptr, "One colour for each submesh."},
    {ShadingMode::Instance, "By instance", nullptr, "One colour for each instance."},
    {ShadingMode::LodState,
     "By LOD state",
     nullptr,
     "How far each submesh is simplified: grey is untouched, the last colour has lost all but a "
     "thousandth of its triangles."},
    {ShadingMode::Texels,
     "Texel density",
     "T",
     "How many texels of the base colour lie along a unit of the surface; what has no texture is "
     "grey."},
}};

constexpr std::array<std::string_view, 4> kBackdrops = {"Dark", "Gradient", "Grey", "Light"};
constexpr std::array<std::string_view, 2> kMaps = {"Viridis", "Cividis"};
constexpr std::array<std::string_view, 3> kNavigations = {"Lodestone", "Blender", "Maya"};

// A submenu of one choice; the chosen one, if another was picked.
template <std::size_t kCount>
std::optional<int> choice(const Ui& ui,
                          const char* title,
                          const std::array<std::string_view, kCount>& items,
                          int selected) {
    std::optional<int> chosen;
    const bool open = ImGui::BeginMenu(title);
    ui.record(title);
    if (!open)
        return chosen;
    for (int at = 0; at < static_cast<int>(kCount); ++at)
        if (menuItem(ui, items[static_cast<std::size_t>(at)], nullptr, at == selected))
            chosen = at;
    ImGui::EndMenu();
    return chosen;
}

} // namespace

std::string_view shadingTitle(ShadingMode shading) {
    for (const ShadingItem& item : kShadings)
        if (item.mode == shading)
            return item.title;
    return {};
}

void displayItems(const Ui& ui, const DisplayOptions& view) {
    DisplayOptions next = view;
    for (const ShadingItem& item : kShadings) {
        const std::string label = "Shading: " + std::string(item.title);
        if (menuItem(ui, label, item.key, view.shading == item.mode))
            next.shading = item.mode;
        tooltip(ui, item.tooltip);
    }
    ImGui::Separator();
    if (menuItem(ui, "Wireframe", "L", view.wireframe))
        next.wireframe = !view.wireframe;
    if (menuItem(ui, "Floor grid", "G", view.grid))
        next.grid = !view.grid;
    if (const auto chosen = choice(ui, "Background", kBackdrops, static_cast<int>(view.backdrop)))
        next.backdrop = static_cast<Backdrop>(*chosen);
    if (const auto chosen = choice(ui, "Colours of numbers", kMaps, static_cast<int>(view.colors)))
        next.colors = static_cast<ColorMap>(*chosen);
    if (const auto chosen =
            choice(ui, "Mouse like", kNavigations, static_cast<int>(view.navigation)))
        next.navigation = static_cast<Navigation>(*chosen);
    if (menuItem(ui, "Light and gloss as at first", nullptr)) {
        const DisplayOptions first;
        next.light_azimuth_deg = first.light_azimuth_deg;
        next.light_elevation_deg = first.light_elevation_deg;
        next.shininess = first.shininess;
    }
    if (!(next == view))
        ui.push(SetView{next});
}

float displayButton(const Ui& ui, const PanelInput& input, float right, float middle) {
    const std::string_view title = shadingTitle(input.document.view.shading);
    const float width = ui.px(120);
    const float height = ui.px(22);
    const ImVec2 min{right - width, middle - height * 0.5f};
    ImGui::SetCursorScreenPos(min);
    if (ImGui::InvisibleButton("display", {width, height}))
        ImGui::OpenPopup("display menu");
    ui.record("display");
    tooltip(ui, "Shading, wireframe, floor, background, colours and mouse habits.");
    const bool hovered = ImGui::IsItemHovered();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(
        min, {right, min.y + height}, hovered ? color::kFieldHovered : color::kField, ui.px(4));
    const float text_y = middle - ImGui::GetTextLineHeight() * 0.5f;
    drawText(ui, {min.x + ui.px(9), text_y}, Align::Left, fitText(ui, title, width - ui.px(28)));
    const ImVec2 tip{right - ui.px(12), middle + ui.px(2.5f)};
    list.AddTriangleFilled(tip - ImVec2(ui.px(4), ui.px(5)),
                           tip + ImVec2(ui.px(4), -ui.px(5)),
                           tip,
                           color::kSecondary);
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {ui.px(10), ui.px(7)});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {ui.px(10), ui.px(8)});
    const bool open = ImGui::BeginPopup("display menu");
    ui.log.object("menu", "display", open ? "\"open\":true" : "\"open\":false");
    if (open) {
        Ui named = ui;
        named.panel = "Display";
        displayItems(named, input.document.view);
        closeOnEscape();
        ImGui::EndPopup();
    }
    ImGui::PopStyleVar(2);
    return min.x;
}

} // namespace lodestone::ui
