#include "app/cli_values.h"

#include <array>
#include <charconv>
#include <cmath>
#include <fmt/core.h>
#include <limits>

namespace lodestone {

namespace {

tl::unexpected<Error>
expected(std::string_view option, std::string_view what, std::string_view text) {
    return fail(ErrorKind::Usage, fmt::format("{} takes {}, not '{}'", option, what, text));
}

template <class T>
bool readWhole(std::string_view text, T& value) {
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    return error == std::errc() && stop == end;
}

} // namespace

Result<double>
parseNumber(std::string_view option, std::string_view text, double low, double high) {
    double value = 0.0;
    if (readWhole(text, value) && std::isfinite(value) && value >= low && value <= high)
        return value;
    const std::string what = high == std::numeric_limits<double>::max()
                                 ? fmt::format("a number of at least {:g}", low)
                                 : fmt::format("a number from {:g} to {:g}", low, high);
    return expected(option, what, text);
}

Result<std::uint64_t>
parseCount(std::string_view option, std::string_view text, std::uint64_t low, std::uint64_t high) {
    std::uint64_t value = 0;
    if (readWhole(text, value) && value >= low && value <= high)
        return value;
    const std::string what = high == std::numeric_limits<std::uint64_t>::max()
                                 ? fmt::format("a whole number of at least {}", low)
                                 : fmt::format("a whole number from {} to {}", low, high);
    return expected(option, what, text);
}

Result<Ordering> parseOrdering(std::string_view text) {
    if (text == "triangle")
        return Ordering::Triangle;
    if (text == "byte")
        return Ordering::Byte;
    if (text == "cost")
        return Ordering::Cost;
    return expected("--ordering", "cost, triangle or byte", text);
}

Result<Instancing> parseInstancing(std::string_view text) {
    if (text == "auto")
        return Instancing::Auto;
    if (text == "nodes")
        return Instancing::Nodes;
    if (text == "gpu")
        return Instancing::Gpu;
    if (text == "expand")
        return Instancing::Expand;
    return expected("--instancing", "auto, nodes, gpu or expand", text);
}

Result<Compression> parseCompression(std::string_view text) {
    if (text == "none")
        return Compression::None;
    if (text == "quantize")
        return Compression::Quantize;
    if (text == "meshopt")
        return Compression::Meshopt;
    if (text == "draco")
        return Compression::Draco;
    return expected("--compress", "none, quantize, meshopt or draco", text);
}

std::vector<std::string> splitList(std::string_view text, char separator) {
    std::vector<std::string> parts;
    std::size_t begin = 0;
    while (true) {
        const std::size_t end = text.find(separator, begin);
        parts.emplace_back(text.substr(begin, end - begin));
        if (end == std::string_view::npos)
            return parts;
        begin = end + 1;
    }
}

Result<OrbitView> parseCamera(std::string_view text) {
    constexpr double kAnyDistance = 1e12;
    const std::vector<std::string> parts = splitList(text, ',');
    if (parts.size() != 3)
        return expected("--camera", "AZIMUTH,ELEVATION,DISTANCE", text);
    const Result<double> azimuth = parseNumber("--camera azimuth", parts[0], -3600.0, 3600.0);
    const Result<double> elevation = parseNumber("--camera elevation", parts[1], -90.0, 90.0);
    const Result<double> distance = parseNumber("--camera distance", parts[2], 0.0, kAnyDistance);
    for (const Result<double>* value : {&azimuth, &elevation, &distance})
        if (!*value)
            return tl::unexpected<Error>(value->error());
    return OrbitView{*azimuth, *elevation, *distance};
}

Result<std::pair<std::string, std::string>> parseAssignment(std::string_view text) {
    const std::size_t equals = text.find('=');
    if (equals == 0 || equals == std::string_view::npos || equals + 1 == text.size())
        return expected("--param", "NAME=VALUE", text);
    return std::pair(std::string(text.substr(0, equals)), std::string(text.substr(equals + 1)));
}

Result<PictureSize> parseSize(std::string_view text) {
    constexpr std::uint64_t kSmallest = 16;
    constexpr std::uint64_t kLargest = 16384;
    const std::vector<std::string> parts = splitList(text, 'x');
    if (parts.size() != 2)
        return expected("--size", "WIDTHxHEIGHT", text);
    const auto width = parseCount("--size width", parts[0], kSmallest, kLargest);
    const auto height = parseCount("--size height", parts[1], kSmallest, kLargest);
    if (!width || !height)
        return tl::unexpected<Error>(!width ? width.error() : height.error());
    return PictureSize{static_cast<std::uint32_t>(*width), static_cast<std::uint32_t>(*height)};
}

Result<Target> parseTarget(const TargetTexts& texts) {
    constexpr std::uint64_t kAnyCount = std::numeric_limits<std::uint64_t>::max();
    constexpr double kAnyError = 100.0;
    int given = 0;
    for (const std::string* text : {&texts.ratio, &texts.triangles, &texts.bytes, &texts.error})
        given += text->empty() ? 0 : 1;
    if (given != 1)
        return fail(ErrorKind::Usage,
                    fmt::format("{}: give exactly one of --ratio, --triangles, --bytes, --error",
                                given == 0 ? "no target" : "more than one target"));
    const auto target = [](Target::Kind kind) {
        return [kind](auto value) { return Target{kind, static_cast<double>(value)}; };
    };
    if (!texts.ratio.empty())
        return parseNumber("--ratio", texts.ratio, 0.0, 1.0).map(target(Target::Kind::Ratio));
    if (!texts.triangles.empty())
        return parseCount("--triangles", texts.triangles, 0, kAnyCount)
            .map(target(Target::Kind::Triangles));
    if (!texts.bytes.empty())
        return parseCount("--bytes", texts.bytes, 1, kAnyCount).map(target(Target::Kind::Bytes));
    return parseNumber("--error", texts.error, 0.0, kAnyError).map(target(Target::Kind::Error));
}

} // namespace lodestone
