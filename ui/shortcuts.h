#pragma once
#include <span>
#include <string_view>

namespace lodestone::ui {

struct Shortcut {
    std::string_view keys;
    std::string_view action;
};

// Every key and mouse action, for the sheet that F1 opens.
std::span<const Shortcut> shortcuts();

} // namespace lodestone::ui
