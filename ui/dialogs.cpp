#include "scene/import.h"
#include "ui/format.h"
#include "ui/lane_text.h"
#include "ui/panels.h"
#include "ui/shortcuts.h"
#include "ui/texture_section.h"
#include "ui/widgets.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace lodestone::ui {

namespace fs = std::filesystem;

namespace {

// One at a time: the popup's name is what tests find.
const char* dialogName(Dialog dialog) {
    switch (dialog) {
    case Dialog::None:
        return "";
    case Dialog::Open:
        return "Open";
    case Dialog::Export:
        return "Export";
    case Dialog::Shortcuts:
        return "Keys and mouse";
    case Dialog::About:
        return "About";
    case Dialog::Quit:
        return "Quit";
    case Dialog::Textures:
        return "Textures";
    }
    return "";
}

void close(WindowState& state) {
    state.dialog = Dialog::None;
    ImGui::CloseCurrentPopup();
}

void drawOpen(const Ui& ui, WindowState& state) {
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    const ImVec2 size{std::min(ui.px(720), display.x - ui.px(80)),
                      std::min(ui.px(460), display.y - ui.px(140))};
    if (const auto file = state.browser.draw(ui, size)) {
        ui.push(OpenScene{*file});
        state.welcome = false;
        close(state);
    }
}

// --- export ---

constexpr std::array kInstancings = {
    Instancing::Auto, Instancing::Gpu, Instancing::Nodes, Instancing::Expand};

std::string_view instancingHelp(Instancing instancing) {
    switch (instancing) {
    case Instancing::Auto:
        return "the smallest of these, by submesh";
    case Instancing::Gpu:
        return "EXT_mesh_gpu_instancing";
    case Instancing::Nodes:
        return "one node an instance, read everywhere";
    case Instancing::Expand:
        return "no instancing, plain triangles";
    }
    return {};
}

constexpr std::array kCompressions = {
    Compression::None, Compression::Quantize, Compression::Meshopt, Compression::Draco};

std::string compressionName(Compression compression) {
    switch (compression) {
    case Compression::None:
        return "none";
    case Compression::Quantize:
        return "quantised (KHR_mesh_quantization)";
    case Compression::Meshopt:
        return "meshopt (EXT_meshopt_compression)";
    case Compression::Draco:
        return "Draco (KHR_draco_mesh_compression)";
    }
    return {};
}

void compressionCombo(const Ui& ui, const PanelInput& input) {
    ExportOptions options = input.document.export_options;
    std::vector<std::string> names;
    names.reserve(kCompressions.size());
    for (const Compression compression : kCompressions)
        names.push_back(compressionName(compression));
    const auto selected = std::ranges::find(kCompressions, options.compression);
    if (const auto chosen =
            combo(ui, "Compression", names, static_cast<int>(selected - kCompressions.begin()))) {
        options.compression = kCompressions[static_cast<std::size_t>(*chosen)];
        ui.push(SetExportOptions{options});
    }
    tooltip(ui,
            "Sizes of meshopt and Draco files are estimates (~) until the file is written. Images "
            "are stored as they are.");
}

// One way to write instances, with its size at the right.
void instancingRow(
    const Ui& ui, const PanelInput& input, LaneId lane, Instancing instancing, float width) {
    ExportOptions options = input.document.export_options;
    const bool selected = options.instancing == instancing;
    options.instancing = instancing;
    const ImVec2 begin = ImGui::GetCursorScreenPos();
    const float height = ui.px(28);
    const std::string name(instancingName(instancing));
    ImGui::PushID(name.c_str());
    if (ImGui::InvisibleButton("option", {width, height}) && !selected)
        ui.push(SetExportOptions{options});
    ui.record(name);
    ImGui::PopID();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    if (selected || ImGui::IsItemHovered())
        list.AddRectFilled(begin,
                           begin + ImVec2(width, height),
                           selected ? color::kSelection : color::kField,
                           ui.px(4));
    const ImVec2 dot = begin + ImVec2(ui.px(14), height * 0.5f);
    list.AddCircle(dot, ui.px(5), selected ? color::kAccent : color::kFaint, 24, ui.px(1.3f));
    if (selected)
        list.AddCircleFilled(dot, ui.px(2.6f), color::kAccent, 20);
    const float y = begin.y + (height - ImGui::GetTextLineHeight()) * 0.5f;
    drawText(ui, {begin.x + ui.px(28), y}, Align::Left, name);
    drawText(ui,
             {begin.x + ui.px(150), y},
             Align::Left,
             instancingHelp(instancing),
             {nullptr, color::kSecondary});
    const auto [size_bytes, estimated] = input.session.predictedSize(lane, options);
    const std::string about = estimated ? "~" : "";
    const float right = begin.x + width - ui.px(10);
    drawText(ui,
             {right, y},
             Align::Right,
             size_bytes > 0 ? about + formatCount(size_bytes) + " B" : std::string(kUnknown),
             {nullptr, color::kSecondary});
    if (size_bytes > 0)
        drawText(ui,
                 {right - ui.px(110), y},
                 Align::Right,
                 about + formatBytes(size_bytes),
                 {ui.theme.fonts.semibold});
}

void tryExport(const Ui& ui, const Lane& lane, WindowState& state) {
    ExportForm& form = state.export_form;
    fs::path path(form.path);
    const std::string extension = path.extension().string();
    if (extension != ".glb" && extension != ".gltf")
        path += ".glb";
    std::error_code ignored;
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    if (!path.has_stem() || !fs::is_directory(folder, ignored)) {
        form.problem = "There is no folder " + folder.string();
        return;
    }
    if (fs::exists(path, ignored) && !form.overwrite_asked) {
        form.overwrite_asked = true;
        form.problem = path.filename().string() + " exists. Press again to overwrite it.";
        return;
    }
    ui.push(Export{lane.id, path});
    close(state);
}

void drawExport(const Ui& ui, const PanelInput& input, WindowState& state) {
    const Lane* const lane = input.document.findLane(input.document.active_lane);
    if (!lane || !lane->status.lod) {
        close(state);
        return;
    }
    ExportForm& form = state.export_form;
    const float width = std::min(ui.px(640), ImGui::GetIO().DisplaySize.x - ui.px(80));
    const std::string title = std::string(laneName(lane->settings)) + " \u00b7 " +
                              formatCount(lane->status.numbers.triangles) + " triangles \u00b7 " +
                              formatRatio(lane->status.numbers.ratio);
    drawText(ui, ImGui::GetCursorScreenPos(), Align::Left, title, {ui.theme.fonts.semibold});
    ImGui::Dummy({width, ui.px(24)});
    sectionTitle(ui, "Instances as");
    for (const Instancing instancing : kInstancings)
        instancingRow(ui, input, lane->id, instancing, width);
    ImGui::Dummy({0, ui.px(6)});
    sectionTitle(ui, "Compression");
    compressionCombo(ui, input);
    ImGui::Dummy({0, ui.px(6)});
    sectionTitle(ui, "File (.glb or .gltf)");
    if (std::exchange(form.focus_path, false))
        ImGui::SetKeyboardFocusHere();
    const std::string before = form.path;
    const bool entered = textField(ui, "Path", form.path, width);
    if (form.path != before) {
        form.overwrite_asked = false;
        form.problem.clear();
    }
    const ImVec2 line = ImGui::GetCursorScreenPos() + ImVec2(0, ui.px(10));
    drawText(ui,
             line,
             Align::Left,
             fitText(ui, form.problem, width - ui.px(220)),
             {nullptr, form.overwrite_asked ? color::kWarning : color::kError});
    ImGui::SetCursorScreenPos({line.x + width - ui.px(208), line.y - ui.px(4)});
    if (button(ui, "Cancel", ui.px(88)))
        close(state);
    ImGui::SameLine();
    ImGui::SetCursorScreenPos({line.x + width - ui.px(112), line.y - ui.px(6)});
    if (primaryButton(ui, form.overwrite_asked ? "Overwrite" : "Export", ui.px(112)) || entered)
        tryExport(ui, *lane, state);
}

// --- small ones ---

bool contains(std::string_view text, std::string_view part) {
    const auto same = [](char a, char b) {
        return std::tolower(static_cast<unsigned char>(a)) ==
               std::tolower(static_cast<unsigned char>(b));
    };
    return std::search(text.begin(), text.end(), part.begin(), part.end(), same) != text.end();
}

// All keys in two columns; typing leaves those that match.
void drawShortcuts(const Ui& ui, WindowState& state) {
    if (ImGui::IsWindowAppearing()) {
        state.sheet_filter.clear();
        ImGui::SetKeyboardFocusHere();
    }
    const float column = ui.px(380);
    const float width = 2 * column + ui.px(24);
    textField(ui, "Search", state.sheet_filter, width);
    if (state.sheet_filter.empty())
        drawText(ui,
                 ImGui::GetItemRectMin() + ImVec2(ui.px(10), ui.px(6)),
                 Align::Left,
                 "Search keys and actions",
                 {nullptr, color::kFaint});
    ImGui::Dummy({0, ui.px(4)});
    const ImVec2 begin = ImGui::GetCursorScreenPos();
    const std::size_t half = (shortcuts().size() + 1) / 2;
    const float line = ui.px(21);
    std::size_t at = 0;
    for (const Shortcut& shortcut : shortcuts()) {
        if (!contains(shortcut.keys, state.sheet_filter) &&
            !contains(shortcut.action, state.sheet_filter))
            continue;
        const float x = begin.x + (at < half ? 0.0f : column + ui.px(24));
        const float y = begin.y + line * static_cast<float>(at < half ? at : at - half);
        drawText(ui, {x, y}, Align::Left, shortcut.keys, {ui.theme.fonts.semibold});
        drawText(
            ui, {x + ui.px(132), y}, Align::Left, shortcut.action, {nullptr, color::kSecondary});
        ++at;
    }
    ui.log.object("sheet", "sheet", "\"rows\":" + std::to_string(at));
    if (at == 0)
        drawText(ui, begin, Align::Left, "No key does that.", {nullptr, color::kSecondary});
    ImGui::Dummy({width, line * static_cast<float>(half) + ui.px(8)});
    if (button(ui, "Close", ui.px(92)))
        close(state);
}

void drawAbout(const Ui& ui, const PanelInput& input, WindowState& state) {
    drawText(ui,
             ImGui::GetCursorScreenPos(),
             Align::Left,
             "Lodestone",
             {ui.theme.fonts.semibold, color::kAccent});
    ImGui::Dummy({ui.px(360), ui.px(22)});
    ImGui::TextUnformatted("Levels of detail of instanced scenes, side by side.");
    ImGui::TextDisabled("Renderer: %s", input.facts.renderer.c_str());
    for (const Algorithm& algorithm : algorithms())
        ImGui::TextDisabled("%.*s: %.*s",
                            static_cast<int>(algorithm.name.size()),
                            algorithm.name.data(),
                            static_cast<int>(algorithm.paper.size()),
                            algorithm.paper.data());
    ImGui::Dummy({0, ui.px(4)});
    if (button(ui, "Close", ui.px(92)))
        close(state);
}

void drawQuit(const Ui& ui, const PanelInput& input, WindowState& state) {
    const std::vector<JobStatus>& jobs = input.document.jobs;
    const bool writing = std::ranges::find(jobs, JobKind::Export, &JobStatus::kind) != jobs.end();
    const char* const loss = writing ? "The export under way is cancelled; no file is changed."
                             : input.document.dirty()
                                 ? "What you changed since the last export is lost."
                                 : "Nothing is lost: there are no changes.";
    drawText(
        ui, ImGui::GetCursorScreenPos(), Align::Left, "Quit Lodestone?", {ui.theme.fonts.semibold});
    ImGui::Dummy({ui.px(320), ui.px(22)});
    ImGui::TextUnformatted(loss);
    ImGui::Dummy({0, ui.px(4)});
    if (button(ui, "Stay", ui.px(92)))
        close(state);
    ImGui::SameLine();
    if (button(ui, "Quit", ui.px(92)) ||
        ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Enter), false)) {
        state.quit = true;
        close(state);
    }
}

} // namespace

void openBrowser(const PanelInput& input, WindowState& state) {
    const fs::path& open = input.document.path;
    fs::path folder = state.browser.folder();
    if (!open.empty())
        folder = open.parent_path();
    state.browser.open(folder, importExtensions(), input.document.recent);
    state.open(Dialog::Open);
}

void openExportDialog(const PanelInput& input, WindowState& state) {
    const Document& document = input.document;
    const Lane* const lane = document.findLane(document.active_lane);
    if (!lane)
        return;
    std::error_code ignored;
    fs::path folder = fs::current_path(ignored);
    if (document.last_export)
        folder = document.last_export->parent_path();
    else if (!document.path.empty())
        folder = document.path.parent_path();
    const fs::path stem =
        document.path.empty() ? fs::path(sceneTitle(document)) : document.path.stem();
    const std::string id = lane->settings.algorithm
                               ? "_" + std::string(lane->settings.algorithm->id)
                               : std::string("_copy");
    state.export_form = {(folder / (stem.string() + id + ".glb")).string(), false, true, {}};
    state.open(Dialog::Export);
}

void drawDialogs(Ui ui, const PanelInput& input, WindowState& state) {
    if (state.dialog == Dialog::None)
        return;
    const char* const name = dialogName(state.dialog);
    ui.panel = name;
    const bool opens = std::exchange(state.dialog_opens, false); // perhaps by Esc itself
    if (opens)
        ImGui::OpenPopup(name);
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({display.x * 0.5f, display.y * 0.46f}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {ui.px(20), ui.px(16)});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, ui.px(6));
    const bool shown = ImGui::BeginPopupModal(
        name,
        nullptr,
        ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
            ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings);
    ImGui::PopStyleVar();
    if (!shown) {
        ImGui::PopStyleVar();
        state.dialog = Dialog::None;
        return;
    }
    sectionTitle(ui, name);
    ImGui::Dummy({0, ui.px(2)});
    switch (state.dialog) {
    case Dialog::None:
        break;
    case Dialog::Open:
        drawOpen(ui, state);
        break;
    case Dialog::Export:
        drawExport(ui, input, state);
        break;
    case Dialog::Shortcuts:
        drawShortcuts(ui, state);
        break;
    case Dialog::About:
        drawAbout(ui, input, state);
        break;
    case Dialog::Quit:
        drawQuit(ui, input, state);
        break;
    case Dialog::Textures:
        if (drawTexturePair(ui, input, state) == DialogStep::Close)
            close(state);
        break;
    }
    if (state.dialog != Dialog::None && !opens &&
        ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape), false))
        close(state);
    ImGui::EndPopup();
    ImGui::PopStyleVar();
}

} // namespace lodestone::ui
