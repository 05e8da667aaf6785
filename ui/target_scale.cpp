#include "ui/target_scale.h"

#include "ui/format.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace lodestone::ui {

namespace {

constexpr double kSmallestBytes = 1024.0;
constexpr double kSmallestError = 1e-4; // % of the diagonal
constexpr double kLargestError = 10.0;

constexpr double kSmallestPixels = 0.1;
constexpr double kLargestPixels = 100.0;

double unitFactor(std::string_view unit) {
    if (unit.empty())
        return 1.0;
    const char letter = unit.front();
    const double base = unit.size() > 1 ? 1024.0 : 1000.0; // "KB" and "KiB" are bytes, "K" a count
    switch (letter) {
    case 'k':
    case 'K':
        return base;
    case 'm':
    case 'M':
        return base * base;
    case 'g':
    case 'G':
        return base * base * base;
    default:
        return 1.0;
    }
}

} // namespace

TargetScale targetScale(const Document& document, Target::Kind kind, std::uint64_t largest_bytes) {
    switch (kind) {
    case Target::Kind::Ratio:
        return {kind, 1.0};
    case Target::Kind::Triangles:
        return {kind, std::max(1.0, static_cast<double>(document.counts.triangles))};
    case Target::Kind::Bytes:
        return {kind,
                std::max(2.0 * kSmallestBytes, static_cast<double>(largest_bytes)),
                kSmallestBytes};
    case Target::Kind::Error:
        return {kind, kLargestError, kSmallestError};
    }
    return {};
}

TargetScale pixelScale() {
    return {Target::Kind::Error, kLargestPixels, kSmallestPixels};
}

double fractionOf(const TargetScale& scale, double value) {
    if (const double low = scale.smallest; low > 0.0) {
        const double along = std::log(std::max(value, low) / low) / std::log(scale.full / low);
        return std::clamp(along, 0.0, 1.0);
    }
    return std::sqrt(std::clamp(value / scale.full, 0.0, 1.0));
}

double valueAt(const TargetScale& scale, double fraction) {
    if (const double low = scale.smallest; low > 0.0) {
        const double value = low * std::pow(scale.full / low, fraction);
        return scale.kind == Target::Kind::Bytes ? std::round(value) : value;
    }
    const double value = scale.full * fraction * fraction;
    if (scale.kind == Target::Kind::Triangles)
        return std::max(1.0, std::round(value));
    return std::max(1e-4, value);
}

std::string formatPixels(double pixels) {
    char text[32] = "";
    std::snprintf(text, sizeof text, "%.*f px", pixels < 9.95 ? 1 : 0, pixels);
    return text;
}

std::string formatTarget(const Target& target) {
    switch (target.kind) {
    case Target::Kind::Ratio:
        return formatRatio(target.value);
    case Target::Kind::Triangles:
        return formatCount(static_cast<std::uint64_t>(std::max(0.0, target.value))) + " tri";
    case Target::Kind::Bytes:
        return formatBytes(static_cast<std::uint64_t>(std::max(0.0, target.value)));
    case Target::Kind::Error:
        return formatError(target.value) + " %";
    }
    return {};
}

std::string editableTarget(const Target& target) {
    char text[48] = "";
    switch (target.kind) {
    case Target::Kind::Ratio:
        std::snprintf(text, sizeof text, "%.4g", target.value * 100.0);
        return text;
    case Target::Kind::Triangles:
        std::snprintf(text, sizeof text, "%.0f", target.value);
        return text;
    default:
        return formatTarget(target);
    }
}

std::optional<double> parseTarget(const TargetScale& scale, std::string_view text) {
    std::string plain(text);
    std::erase(plain, ',');
    char* end = nullptr;
    double value = std::strtod(plain.c_str(), &end);
    if (end == plain.c_str() || !std::isfinite(value))
        return std::nullopt;
    while (*end == ' ')
        ++end;
    const std::string_view unit(end);
    if (scale.kind == Target::Kind::Ratio)
        value /= 100.0;
    else if (scale.kind != Target::Kind::Error)
        value *= unitFactor(unit);
    if (!(value > 0.0))
        return std::nullopt;
    return scale.kind == Target::Kind::Ratio ? std::min(value, 1.0) : value;
}

} // namespace lodestone::ui
