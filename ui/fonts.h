#pragma once
#include "ui/theme.h"

#include <filesystem>

namespace lodestone::ui {

// Fills the current context's font atlas from the system's fonts (Inter, else Noto Sans, else
// DejaVu Sans), ImGui's own where fontconfig finds none of them. Digits get one common advance, so
// that numbers do not dance while a slider moves. scale: framebuffer pixels per design pixel.
Fonts loadFonts(float scale);
// The file of the regular font that loadFonts takes; empty: there is none.
std::filesystem::path systemFontFile();

} // namespace lodestone::ui
