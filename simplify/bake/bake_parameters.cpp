#include "simplify/bake/bake_parameters.h"

#include <algorithm>

namespace lodestone {

namespace {

constexpr std::string_view kTexture = "texture";
constexpr std::string_view kAtlas = "atlas";
constexpr std::string_view kMerge = "merge-materials";
constexpr std::string_view kBetter = "keep-better";
constexpr std::string_view kFormat = "atlas-format";
constexpr std::string_view kQuality = "jpeg-quality";

ParameterInfo made(std::string_view id, std::string_view label, std::string_view tooltip) {
    ParameterInfo info;
    info.id = id;
    info.label = label;
    info.tooltip = tooltip;
    info.of_textures = true;
    info.needs = id == kTexture ? std::string_view() : kTexture;
    return info;
}

} // namespace

void addBakeParameters(std::vector<ParameterInfo>& parameters) {
    const BakeOptions options;
    ParameterInfo texture = made(
        kTexture,
        "Textures",
        "Keep the texture coordinates, or transfer: every triangle gets texels of its own in a new "
        "atlas, painted with what the original shows there.");
    texture.kind = ParameterInfo::Kind::Choice;
    texture.choices = {"keep", "transfer"};
    ParameterInfo atlas = made(kAtlas, "Atlas size", "Side of each new texture.");
    atlas.kind = ParameterInfo::Kind::Integer;
    atlas.unit = "px";
    atlas.minimum = 256.0;
    atlas.maximum = 8192.0;
    atlas.fallback = options.atlas_px;
    atlas.logarithmic = true;
    ParameterInfo merge = made(
        kMerge, "One atlas for all", "Materials that blend alike share one atlas and become one.");
    merge.kind = ParameterInfo::Kind::Toggle;
    ParameterInfo better = made(kBetter,
                                "Keep where better",
                                "Materials whose textures still show the original at least as well "
                                "as a new atlas, in no more bytes, keep them: tiled ones, mostly.");
    better.kind = ParameterInfo::Kind::Toggle;
    ParameterInfo format =
        made(kFormat,
             "Atlas format",
             "auto: JPEG where the original's textures are, nothing is transparent and it is "
             "smaller; else PNG, which loses nothing.");
    format.kind = ParameterInfo::Kind::Choice;
    format.choices = {"auto", "png", "jpeg"};
    ParameterInfo quality = made(kQuality,
                                 "JPEG quality",
                                 "Of atlases that are written as JPEG. Above 90 colours are stored "
                                 "at full resolution.");
    quality.kind = ParameterInfo::Kind::Integer;
    quality.minimum = 1.0;
    quality.maximum = 100.0;
    quality.fallback = options.jpeg_quality;
    parameters.insert(parameters.end(), {texture, atlas, merge, better, format, quality});
}

std::optional<BakeOptions> bakeOptions(const Algorithm& algorithm, const ParameterValues& values) {
    const auto value = [&](std::string_view id) { return parameterValue(algorithm, values, id); };
    if (std::ranges::find(algorithm.parameters, kTexture, &ParameterInfo::id) ==
            algorithm.parameters.end() ||
        value(kTexture) < 0.5)
        return std::nullopt;
    BakeOptions options;
    options.atlas_px = static_cast<std::uint32_t>(value(kAtlas));
    options.merge_materials = value(kMerge) > 0.5;
    options.keep_better = value(kBetter) > 0.5;
    options.format = static_cast<AtlasFormat>(value(kFormat));
    options.jpeg_quality = static_cast<int>(value(kQuality));
    return options;
}

} // namespace lodestone
