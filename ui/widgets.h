#pragma once
// The window's own widgets, drawn with ImGui's draw lists. Each records its rectangle under its
// label; labels are unique within a panel. Main thread, within a window.
#include "ui/ui.h"

#include <optional>
#include <span>

namespace lodestone::ui {

// --- text ---
enum class Align : std::uint8_t { Left, Center, Right };

struct TextStyle {
    ImFont* font = nullptr; // null: regular
    ImU32 colour = color::kText;
};

float textWidth(const Ui& ui, std::string_view text, ImFont* font = nullptr);
// position: the top left, top centre or top right corner of the text.
void drawText(const Ui& ui,
              const ImVec2& position,
              Align align,
              std::string_view text,
              const TextStyle& style = {});
// The text, shortened with an ellipsis until it fits into width.
std::string fitText(const Ui& ui, std::string_view text, float width, ImFont* font = nullptr);
// A section's title: small capitals, tracked. ASCII letters are raised.
void sectionTitle(const Ui& ui, std::string_view text);
// Label left, value right, on one line of the panel; suffix in small secondary text behind it.
void labelledValue(const Ui& ui,
                   std::string_view label,
                   std::string_view value,
                   std::string_view suffix = {});
// Tooltip of the last item, wrapped; nothing for an empty text.
void tooltip(const Ui& ui, std::string_view text);

// --- marks ---
void horizontalHairline(const Ui& ui, float x_begin, float x_end, float y);
void verticalHairline(const Ui& ui, float x, float y_begin, float y_end);
void progressLine(const Ui& ui, const ImVec2& min, float width, double fraction, ImU32 colour);
// At the lower edge of the present child window, where more of its content lies below.
void fadeWhereMore(const Ui& ui, ImU32 background);
void spinner(const Ui& ui, const ImVec2& center, float radius, ImU32 colour);

// --- controls ---
struct SliderSpec {
    std::string_view label;
    std::string value;     // as shown at the right of the label
    std::string edit_text; // what typing starts with; empty: cannot be typed
    double fraction = 0.0; // 0..1
    std::string_view tooltip;
    ImU32 colour = color::kAccent;
    bool enabled = true;
};

struct SliderEvent {
    std::optional<double> fraction;   // the new place, while it is dragged
    std::optional<std::string> typed; // confirmed text
    bool released = false;            // the drag ended
    DragKey drag = 0;
};

// Label and value on one line, a thin track with a round grab below. Click on the value to type.
SliderEvent slider(const Ui& ui, const SliderSpec& spec);
// The track alone, in the given width.
SliderEvent sliderTrack(const Ui& ui, const SliderSpec& spec, float width);

struct SegmentedSpec {
    std::string_view label;
    std::span<const std::string_view> items;
    int selected = -1;
    std::span<const std::string_view> tooltips; // as many as items, or none
    float width = 0.0f;                         // 0: as wide as the items need
};

float segmentedWidth(const Ui& ui, std::span<const std::string_view> items);
// One of few: the chosen item, if another was clicked.
std::optional<int> segmented(const Ui& ui, const SegmentedSpec& spec);

// width 0: as wide as its text.
bool primaryButton(const Ui& ui, std::string_view label, float width);
bool button(const Ui& ui, std::string_view label, float width = 0.0f);
// Text that can be clicked.
bool linkButton(const Ui& ui, std::string_view label, ImU32 colour = color::kText);
bool toggle(const Ui& ui, std::string_view label, bool& value);
// Closes the popup that is being drawn, with all of its submenus, once Esc is pressed.
void closeOnEscape();
// The chosen item, if another was picked. preview: what the closed box shows.
std::optional<int>
combo(const Ui& ui, std::string_view label, std::span<const std::string> items, int selected);
bool textField(const Ui& ui, std::string_view label, std::string& text, float width);
bool menuItem(const Ui& ui,
              std::string_view label,
              const char* shortcut,
              bool selected = false,
              bool enabled = true);

// --- panels and dialogs ---
enum class PanelScroll : std::uint8_t { None, Vertical };

// A fixed part of the window. Always pair with endPanel().
void beginPanel(const char* name, const ImVec2& position, const ImVec2& size, PanelScroll scroll);
void endPanel();

} // namespace lodestone::ui
