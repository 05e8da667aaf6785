#pragma once
// Our own file browser: places at the left, folders and readable files at the right, a path that
// can be typed, all of it by keyboard too. Knows the disk, not the document.
#include "ui/ui.h"

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace lodestone::ui {

class FileBrowser {
public:
    // Shows `folder` (the working directory if empty or gone) with files of these extensions
    // (lower case, with dot). recent: files whose folders are offered as places.
    void open(std::filesystem::path folder,
              std::span<const std::string_view> extensions,
              std::span<const std::filesystem::path> recent);

    // Draws the inside of the dialog. The file, once one is chosen.
    std::optional<std::filesystem::path> draw(const Ui& ui, const ImVec2& size);

    const std::filesystem::path& folder() const { return folder_; }

private:
    struct Entry {
        std::string name;
        bool is_folder = false;
        std::uint64_t size_bytes = 0;
    };

    struct Place {
        std::string name;
        std::filesystem::path folder;
    };

    void enter(std::filesystem::path folder);
    void addPlace(std::string name, const std::filesystem::path& folder);
    bool readable(const std::filesystem::path& file) const;
    bool passesFilter(const Entry& entry) const;
    std::optional<std::filesystem::path> activate(const Entry& entry);
    std::optional<std::filesystem::path> acceptTyped();
    void drawPlaces(const Ui& ui, const ImVec2& size);
    std::optional<std::filesystem::path> drawEntries(const Ui& ui, const ImVec2& size);
    void moveSelection();

    std::filesystem::path folder_;
    std::vector<std::string> extensions_;
    std::vector<Entry> entries_;
    std::vector<Place> places_;
    std::string typed_; // path field
    std::string problem_;
    int selected_ = -1; // in entries_
    bool focus_path_ = false;
    bool scroll_to_selected_ = false;
};

} // namespace lodestone::ui
