#include "ui/format.h"

#include <array>
#include <cmath>
#include <cstdio>

namespace lodestone::ui {

namespace {

std::string decimals(double value, int digits) {
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), "%.*f", digits, value);
    return text.data();
}

// Three significant digits while below 1,000.
std::string threeDigits(double value) {
    if (value < 9.995)
        return decimals(value, 2);
    if (value < 99.95)
        return decimals(value, 1);
    return decimals(value, 0);
}

} // namespace

std::string formatCount(std::uint64_t count) {
    std::string text = std::to_string(count);
    for (std::ptrdiff_t at = static_cast<std::ptrdiff_t>(text.size()) - 3; at > 0; at -= 3)
        text.insert(static_cast<std::size_t>(at), "\u2009");
    return text;
}

std::string formatRate(double frames_per_second) {
    return decimals(frames_per_second, frames_per_second < 9.95 ? 1 : 0);
}

std::string formatShortCount(std::uint64_t count) {
    const auto value = static_cast<double>(count);
    if (count < 1'000)
        return std::to_string(count);
    if (count < 999'500)
        return threeDigits(value / 1e3) + " K";
    if (count < 999'500'000)
        return threeDigits(value / 1e6) + " M";
    return threeDigits(value / 1e9) + " G";
}

std::string formatBytes(std::uint64_t size_bytes) {
    if (size_bytes == 0)
        return "\u2026"; // not known yet
    constexpr std::array<const char*, 4> kUnits = {" KiB", " MiB", " GiB", " TiB"};
    if (size_bytes < 1024)
        return std::to_string(size_bytes) + " B";
    double value = static_cast<double>(size_bytes) / 1024.0;
    std::size_t unit = 0;
    while (value >= 999.5 && unit + 1 < kUnits.size()) {
        value /= 1024.0;
        ++unit;
    }
    return threeDigits(value) + kUnits[unit];
}

std::string formatRatio(double ratio) {
    const double percent = ratio * 100.0;
    if (percent > 0.0 && percent < 0.95)
        return decimals(percent, 2) + " %";
    return decimals(percent, 1) + " %";
}

std::string formatChange(double before, double after) {
    if (!(before > 0.0))
        return kUnknown;
    const double percent = (after / before - 1.0) * 100.0;
    if (percent >= 999.5)
        return "\u00d7 " + threeDigits(after / before);
    return (percent < 0.0 ? "\u2212 " : "+ ") + decimals(std::abs(percent), 1) + " %";
}

std::string formatSeconds(double time_s) {
    if (time_s < 0.00995)
        return formatMilliseconds(time_s * 1e3);
    if (time_s < 0.9995)
        return decimals(time_s, 2) + " s";
    if (time_s < 60.0)
        return decimals(time_s, 1) + " s";
    const auto whole = static_cast<int>(time_s);
    return std::to_string(whole / 60) + " min " + std::to_string(whole % 60) + " s";
}

std::string formatMilliseconds(double time_ms) {
    return (time_ms < 99.95 ? decimals(time_ms, 1) : decimals(time_ms, 0)) + " ms";
}

std::string formatError(double error_rel_percent) {
    constexpr double kSmallestShown = 0.00005;
    if (error_rel_percent < kSmallestShown)
        return "0";
    if (error_rel_percent < 0.01)
        return decimals(error_rel_percent, 4);
    return decimals(error_rel_percent, error_rel_percent < 1.0 ? 3 : 2);
}

} // namespace lodestone::ui
