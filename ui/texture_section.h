#pragma once
// What the inspector shows of a lane's textures, and the dialog that shows them large.
#include "ui/window_state.h"

namespace lodestone::ui {

// Whether textures are kept or transferred, and of a transfer its options, how fine its texels are
// and its first atlas beside what it was made from; a click shows them large. Nothing for
// algorithms that cannot transfer.
void drawTextureSection(const Ui& ui,
                        const PanelInput& input,
                        WindowState& state,
                        const Lane& lane);

enum class DialogStep : std::uint8_t { Stay, Close };

// Within a dialog: the active lane's atlases beside what they were made from, one pair at a time.
DialogStep drawTexturePair(const Ui& ui, const PanelInput& input, WindowState& state);

} // namespace lodestone::ui
