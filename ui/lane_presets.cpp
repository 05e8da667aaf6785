#include "ui/lane_presets.h"

#include "app/lane.h"

namespace lodestone::ui {

namespace {

constexpr std::array<std::string_view, 3> kTwo = {"", "ias", "quadric"};
constexpr std::array<std::string_view, 6> kSix = {"vt", "fad", "ivdd", "ss", "vtd", "fass"};
constexpr std::array<std::string_view, 9> kNine = {
    "", "quadric", "ias", "vt", "fad", "ivdd", "ss", "vtd", "fass"};
constexpr std::array<LanePreset, 3> kPresets = {{{"IAS vs Quadric", "Ctrl+3", '3', kTwo},
                                                 {"Six methods", "Ctrl+6", '6', kSix},
                                                 {"All nine", "Ctrl+9", '9', kNine}}};

} // namespace

std::span<const LanePreset> lanePresets() {
    return kPresets;
}

std::vector<std::string> presetLanes(const LanePreset& preset) {
    std::vector<std::string> ids;
    for (const std::string_view id : preset.ids)
        if (id.empty() || findAlgorithm(id))
            ids.emplace_back(id);
    return ids;
}

} // namespace lodestone::ui
