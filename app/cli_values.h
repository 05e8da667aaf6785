#pragma once
// Strict readers of option texts: the whole text or a Usage error that says what was expected.
#include "app/image_source.h"
#include "simplify/lod_source.h"

namespace lodestone {

Result<double> parseNumber(std::string_view option, std::string_view text, double low, double high);
Result<std::uint64_t>
parseCount(std::string_view option, std::string_view text, std::uint64_t low, std::uint64_t high);
Result<Ordering> parseOrdering(std::string_view text);       // cost|triangle|byte
Result<Instancing> parseInstancing(std::string_view text);   // auto|nodes|gpu|expand
Result<Compression> parseCompression(std::string_view text); // none|quantize|meshopt|draco
Result<OrbitView> parseCamera(std::string_view text);        // AZ,EL,DIST
// NAME=VALUE
Result<std::pair<std::string, std::string>> parseAssignment(std::string_view text);
std::vector<std::string> splitList(std::string_view text, char separator);

struct PictureSize {
    std::uint32_t width_px = 0;
    std::uint32_t height_px = 0;
};

Result<PictureSize> parseSize(std::string_view text); // WxH, 16..16384 each

// The texts of the four target options; empty: not given.
struct TargetTexts {
    std::string ratio;
    std::string triangles;
    std::string bytes;
    std::string error;
};

// Exactly one of them. Usage error if there is none or more than one.
Result<Target> parseTarget(const TargetTexts& texts);

} // namespace lodestone
