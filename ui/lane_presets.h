#pragma once
// Lanes that are compared often.
#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lodestone::ui {

struct LanePreset {
    std::string_view name;
    const char* shortcut = "";
    int key = 0;                           // with Ctrl; ASCII
    std::span<const std::string_view> ids; // of algorithms; empty text: Original
};

// In the order of the menu.
std::span<const LanePreset> lanePresets();

// Those of the preset that this build knows.
std::vector<std::string> presetLanes(const LanePreset& preset);

} // namespace lodestone::ui
