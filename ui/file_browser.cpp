#include "ui/file_browser.h"

#include "ui/format.h"
#include "ui/widgets.h"

#include <algorithm>
#include <cstdlib>
#include <imgui_stdlib.h>

namespace lodestone::ui {

namespace fs = std::filesystem;

namespace {

std::string lowered(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](char letter) {
        return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
    });
    return text;
}

fs::path homeFolder() {
    const char* const home = std::getenv("HOME");
    return home ? fs::path(home) : fs::path();
}

// "~" at the beginning stands for the home folder.
fs::path expanded(const std::string& typed, const fs::path& base) {
    if (typed == "~" || typed.starts_with("~/"))
        return homeFolder() / (typed.size() > 2 ? typed.substr(2) : std::string());
    const fs::path path(typed);
    return path.is_absolute() ? path : base / path;
}

// A folder, drawn: 13 px wide.
void folderMark(const Ui& ui, const ImVec2& at) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(at, at + ImVec2(ui.px(6), ui.px(4)), color::kSecondary, ui.px(1));
    list.AddRectFilled(at + ImVec2(0, ui.px(2)),
                       at + ImVec2(ui.px(13), ui.px(11)),
                       color::kSecondary,
                       ui.px(1.5f));
}

} // namespace

void FileBrowser::open(fs::path folder,
                       std::span<const std::string_view> extensions,
                       std::span<const fs::path> recent) {
    extensions_.assign(extensions.begin(), extensions.end());
    places_.clear();
    std::error_code ignored;
    addPlace("Home", homeFolder());
    addPlace("Working folder", fs::current_path(ignored));
    addPlace("Computer", "/");
    for (const fs::path& file : recent)
        if (places_.size() < 9)
            addPlace(file.parent_path().filename().string(), file.parent_path());
    if (folder.empty() || !fs::is_directory(folder, ignored))
        folder = fs::current_path(ignored);
    enter(std::move(folder));
    focus_path_ = true;
}

void FileBrowser::addPlace(std::string name, const fs::path& folder) {
    std::error_code ignored;
    if (folder.empty() || !fs::is_directory(folder, ignored))
        return;
    for (const Place& place : places_)
        if (place.folder == folder)
            return;
    places_.push_back({name.empty() ? folder.string() : std::move(name), folder});
}

bool FileBrowser::readable(const fs::path& file) const {
    const std::string extension = lowered(file.extension().string());
    return std::find(extensions_.begin(), extensions_.end(), extension) != extensions_.end();
}

void FileBrowser::enter(fs::path folder) {
    std::error_code error;
    const fs::path resolved = fs::weakly_canonical(folder, error);
    if (!error)
        folder = resolved;
    fs::directory_iterator entry(folder, fs::directory_options::skip_permission_denied, error);
    if (error) {
        problem_ = "Cannot read " + folder.string() + ": " + error.message();
        return;
    }
    problem_.clear();
    folder_ = std::move(folder);
    entries_.clear();
    for (; entry != fs::directory_iterator(); entry.increment(error)) {
        if (error)
            break;
        std::error_code ignored;
        const std::string name = entry->path().filename().string();
        const bool is_folder = entry->is_directory(ignored);
        if (name.starts_with(".") || (!is_folder && !readable(entry->path())))
            continue;
        const std::uintmax_t size_bytes = is_folder ? 0 : entry->file_size(ignored);
        entries_.push_back({name, is_folder, ignored ? 0 : size_bytes});
    }
    std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
        if (a.is_folder != b.is_folder)
            return a.is_folder;
        return std::pair(lowered(a.name), a.name) < std::pair(lowered(b.name), b.name);
    });
    typed_ = (folder_ / "").string();
    selected_ = -1;
}

// What stands behind the last slash of the path field filters the list.
bool FileBrowser::passesFilter(const Entry& entry) const {
    const std::size_t slash = typed_.find_last_of('/');
    const std::string filter =
        lowered(slash == std::string::npos ? typed_ : typed_.substr(slash + 1));
    return filter.empty() || lowered(entry.name).find(filter) != std::string::npos;
}

std::optional<fs::path> FileBrowser::activate(const Entry& entry) {
    const fs::path path = folder_ / entry.name;
    if (!entry.is_folder)
        return path;
    enter(path);
    focus_path_ = true;
    return std::nullopt;
}

std::optional<fs::path> FileBrowser::acceptTyped() {
    if (selected_ >= 0)
        return activate(Entry(entries_[static_cast<std::size_t>(selected_)]));
    const fs::path path = expanded(typed_, folder_);
    std::error_code ignored;
    focus_path_ = true;
    if (fs::is_directory(path, ignored)) {
        enter(path);
        return std::nullopt;
    }
    if (fs::exists(path, ignored))
        return path;
    problem_ = "There is no file " + path.string();
    return std::nullopt;
}

void FileBrowser::drawPlaces(const Ui& ui, const ImVec2& size) {
    ImGui::BeginChild("places", size);
    sectionTitle(ui, "Places");
    std::optional<fs::path> wanted;
    for (const Place& place : places_) {
        ImGui::PushID(place.folder.c_str());
        const std::string label = fitText(ui, place.name, size.x - ui.px(16));
        if (ImGui::Selectable(label.c_str(), place.folder == folder_))
            wanted = place.folder;
        ui.record("place " + place.name);
        tooltip(ui, place.folder.string());
        ImGui::PopID();
    }
    ImGui::EndChild();
    if (wanted)
        enter(std::move(*wanted));
}

void FileBrowser::moveSelection() {
    const int step = ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_DownArrow)) ? 1
                     : ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_UpArrow)) ? -1
                                                                                 : 0;
    const auto count = static_cast<int>(entries_.size());
    if (step == 0)
        return;
    for (int at = selected_ + step; at >= 0 && at < count; at += step)
        if (passesFilter(entries_[static_cast<std::size_t>(at)])) {
            selected_ = at;
            scroll_to_selected_ = true;
            return;
        }
}

std::optional<fs::path> FileBrowser::drawEntries(const Ui& ui, const ImVec2& size) {
    std::optional<Entry> activated;
    ImGui::BeginChild("files", size);
    const float right = ImGui::GetWindowPos().x + size.x - ui.px(16);
    for (std::size_t at = 0; at < entries_.size(); ++at) {
        const Entry& entry = entries_[at];
        if (!passesFilter(entry))
            continue;
        const bool is_selected = static_cast<int>(at) == selected_;
        ImGui::PushID(static_cast<int>(at));
        const ImVec2 begin = ImGui::GetCursorScreenPos();
        if (ImGui::Selectable("##entry", is_selected, ImGuiSelectableFlags_AllowDoubleClick)) {
            selected_ = static_cast<int>(at);
            if (entry.is_folder || ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left))
                activated = entry;
        }
        if (is_selected && std::exchange(scroll_to_selected_, false))
            ImGui::SetScrollHereY();
        ui.record("entry " + entry.name);
        if (entry.is_folder)
            folderMark(ui, {begin.x, begin.y + ui.px(2)});
        else
            drawText(ui,
                     {right, begin.y},
                     Align::Right,
                     formatBytes(entry.size_bytes),
                     {nullptr, color::kSecondary});
        drawText(ui,
                 {begin.x + ui.px(20), begin.y},
                 Align::Left,
                 fitText(ui, entry.name, right - begin.x - ui.px(110)));
        ImGui::PopID();
    }
    if (entries_.empty())
        ImGui::TextDisabled("Nothing here that can be opened.");
    ImGui::EndChild();
    return activated ? activate(*activated) : std::nullopt;
}

std::optional<fs::path> FileBrowser::draw(const Ui& ui, const ImVec2& size) {
    std::optional<fs::path> chosen;
    const float places_width = ui.px(150);
    const float field_height = ImGui::GetFrameHeightWithSpacing();
    if (std::exchange(focus_path_, false))
        ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(size.x);
    const std::string before = typed_;
    const bool entered = ImGui::InputText("##path", &typed_, ImGuiInputTextFlags_EnterReturnsTrue);
    ui.record("Path");
    if (typed_ != before)
        selected_ = -1;
    moveSelection();
    if (entered)
        chosen = acceptTyped();
    const float footer = ui.px(40);
    const ImVec2 inner{0, size.y - field_height - footer};
    drawPlaces(ui, {places_width, inner.y});
    ImGui::SameLine();
    if (const auto picked = drawEntries(ui, {size.x - places_width - ui.px(8), inner.y}))
        chosen = picked;
    const std::string hint =
        problem_.empty() ? "Type a path or a part of a name. Enter opens." : problem_;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    drawText(ui,
             at + ImVec2(0, ui.px(12)),
             Align::Left,
             fitText(ui, hint, size.x - ui.px(120)),
             {nullptr, problem_.empty() ? color::kSecondary : color::kError});
    ImGui::SetCursorScreenPos(at + ImVec2(size.x - ui.px(92), ui.px(4)));
    ImGui::BeginDisabled(typed_.empty());
    if (primaryButton(ui, "Open", ui.px(92)))
        chosen = acceptTyped();
    ImGui::EndDisabled();
    return chosen;
}

} // namespace lodestone::ui
