#include "app/lane.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lodestone {

bool operator==(const LaneSettings& a, const LaneSettings& b) {
    return a.algorithm == b.algorithm && a.parameters == b.parameters && a.ordering == b.ordering &&
           a.target.kind == b.target.kind && a.target.value == b.target.value &&
           a.position == b.position && a.error_px == b.error_px &&
           a.follows_master == b.follows_master && a.colour == b.colour;
}

DrawnLod drawnLod(const LaneStatus& status) {
    if (status.textures && status.textures->lod_revision == status.lod_revision)
        return {status.textures->baked.scene, status.textures->lod};
    return {status.scene, status.lod};
}

std::string_view laneStateName(LaneState state) {
    constexpr std::array<std::string_view, 5> kNames = {
        "idle", "queued", "building", "ready", "failed"};
    return kNames.at(static_cast<std::size_t>(state));
}

std::string_view laneName(const LaneSettings& settings) {
    return settings.algorithm ? settings.algorithm->short_name : "Original";
}

namespace {

struct NamedColour {
    std::string_view algorithm;
    Rgb colour;
};

constexpr Rgb kOriginalColour{0x9a, 0xa3, 0xaf};
constexpr std::array<NamedColour, 4> kColours = {{{"ias", {0x4c, 0xc2, 0xa0}},
                                                  {"quadric", {0xe3, 0xa4, 0x4d}},
                                                  {"quadric-submesh", {0xd9, 0x8c, 0x6a}},
                                                  {"wild", {0x6a, 0xa9, 0xff}}}};
// For algorithms without a colour of their own; told apart by colour-blind people (Okabe, Ito
// 2008).
constexpr std::array<Rgb, 6> kFurtherColours = {{{0xcc, 0x79, 0xa7},
                                                 {0x56, 0xb4, 0xe9},
                                                 {0xf0, 0xe4, 0x42},
                                                 {0xd5, 0x5e, 0x00},
                                                 {0x00, 0x9e, 0x73},
                                                 {0x00, 0x72, 0xb2}}};

Rgb baseColour(const Algorithm* algorithm) {
    if (!algorithm)
        return kOriginalColour;
    for (const NamedColour& named : kColours)
        if (named.algorithm == algorithm->id)
            return named.colour;
    std::size_t row = 0;
    for (const Algorithm& candidate : algorithms()) {
        if (&candidate == algorithm)
            break;
        ++row;
    }
    return kFurtherColours[row % kFurtherColours.size()];
}

std::uint8_t lighter(std::uint8_t channel, double share) {
    return static_cast<std::uint8_t>(std::lround(channel + (255.0 - channel) * share));
}

} // namespace

Rgb laneColour(const Algorithm* algorithm, std::uint32_t earlier_lanes_of_it) {
    const Rgb base = baseColour(algorithm);
    const double share = 1.0 - std::pow(0.7, static_cast<double>(earlier_lanes_of_it));
    return Rgb{lighter(base.r, share), lighter(base.g, share), lighter(base.b, share)};
}

Rgb freeLaneColour(std::span<const Lane> lanes, const Algorithm* algorithm, LaneId except) {
    for (std::uint32_t shade = 0; shade <= lanes.size(); ++shade) {
        const Rgb colour = laneColour(algorithm, shade);
        const bool taken = std::ranges::any_of(lanes, [&](const Lane& lane) {
            return lane.id != except && lane.settings.algorithm == algorithm &&
                   lane.settings.colour == colour;
        });
        if (!taken)
            return colour;
    }
    return laneColour(algorithm, 0);
}

} // namespace lodestone
