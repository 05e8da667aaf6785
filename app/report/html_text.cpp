#include "app/report/html_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/core.h>

namespace lodestone {

namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD"; // U+FFFD

// Bytes of the UTF-8 sequence at the front of the text; 0 if it is none that XML allows.
std::size_t utf8Length(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char lead = byte(0);
    if (lead < 0x80)
        return lead >= 0x20 || lead == '\t' || lead == '\n' || lead == '\r' ? 1 : 0;
    const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
    if (lead < 0xC2 || lead > 0xF4 || text.size() < length)
        return 0;
    char32_t code = lead & (0xFFu >> (length + 1));
    for (std::size_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xC0u) != 0x80)
            return 0;
        code = code << 6 | (byte(i) & 0x3Fu);
    }
    constexpr std::array<char32_t, 5> kSmallest = {0, 0, 0x80, 0x800, 0x10000};
    const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
    const bool forbidden = code == 0xFFFE || code == 0xFFFF || code > 0x10FFFF;
    return code < kSmallest[length] || surrogate || forbidden ? 0 : length;
}

// Three digits that count: "1.82", "38.2", "412".
std::string threeDigits(double value) {
    const double size = std::abs(value);
    return fmt::format("{:.{}f}", value, size >= 99.95 ? 0 : size >= 9.995 ? 1 : 2);
}

std::string hex(Rgb colour) {
    return fmt::format("#{:02x}{:02x}{:02x}", colour.r, colour.g, colour.b);
}

double linear(std::uint8_t channel) {
    const double value = channel / 255.0;
    return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

double luminance(Rgb colour) {
    return 0.2126 * linear(colour.r) + 0.7152 * linear(colour.g) + 0.0722 * linear(colour.b);
}

// As dark as lines on white must be: a contrast of at least 3 : 1 (WCAG 2.1, 1.4.11).
Rgb onLight(Rgb colour) {
    constexpr double kBrightest = 1.05 / 3.2 - 0.05;
    const auto darker = [](std::uint8_t channel) {
        return static_cast<std::uint8_t>(channel * 0.95);
    };
    while (luminance(colour) > kBrightest)
        colour = {darker(colour.r), darker(colour.g), darker(colour.b)};
    return colour;
}

// As bright as lines on the dark background must be.
Rgb onDark(Rgb colour) {
    constexpr double kDarkest = 0.16;
    const auto brighter = [](std::uint8_t channel) {
        return static_cast<std::uint8_t>(std::min(255, channel + 8));
    };
    while (luminance(colour) < kDarkest)
        colour = {brighter(colour.r), brighter(colour.g), brighter(colour.b)};
    return colour;
}

} // namespace

std::string escaped(std::string_view text) {
    std::string result;
    result.reserve(text.size());
    while (!text.empty()) {
        const std::size_t length = utf8Length(text);
        switch (length == 0 ? '\0' : text.front()) {
        case '\0':
            result += kReplacement;
            break;
        case '&':
            result += "&amp;";
            break;
        case '<':
            result += "&lt;";
            break;
        case '>':
            result += "&gt;";
            break;
        case '"':
            result += "&quot;";
            break;
        case '\'':
            result += "&#39;";
            break;
        default:
            result += text.substr(0, length);
        }
        text.remove_prefix(std::max<std::size_t>(length, 1));
    }
    return result;
}

std::string base64(std::string_view bytes) {
    static constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            text += k <= count ? kDigits[group >> (18 - 6 * k) & 63u] : '=';
    }
    return text;
}

std::string secondsText(double seconds) {
    if (seconds >= 1.0)
        return threeDigits(seconds) + " s";
    const double ms = 1000.0 * seconds;
    return fmt::format("{:.{}f} ms", ms, ms >= 9.95 ? 0 : 1);
}

std::string percentText(double percent) {
    if (percent >= 99.95 || percent == std::round(percent))
        return fmt::format("{:.0f} %", percent);
    return fmt::format("{:.{}f} %", percent, percent >= 1.0 ? 1 : 2);
}

std::string compactCount(double value) {
    if (value >= 1e9)
        return fmt::format("{:g} G", value / 1e9);
    if (value >= 1e6)
        return fmt::format("{:g} M", value / 1e6);
    if (value >= 1e3)
        return fmt::format("{:g} K", value / 1e3);
    return fmt::format("{:g}", value);
}

std::string fixedText(double value, int decimals) {
    return fmt::format("{:.{}f}", value, decimals);
}

int decimalsFor(double smallest) {
    if (!(smallest > 0.0))
        return 0;
    return std::clamp(1 - static_cast<int>(std::floor(std::log10(smallest))), 0, 5);
}

std::string laneStyle(const Algorithm* algorithm) {
    const Rgb colour = laneColour(algorithm, 0);
    return fmt::format("--on-dark:{};--on-light:{}", hex(onDark(colour)), hex(onLight(colour)));
}

} // namespace lodestone
