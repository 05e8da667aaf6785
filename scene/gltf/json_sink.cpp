#include "scene/gltf/json_sink.h"

#include <array>
#include <cassert>

namespace lodestone {

using nlohmann::json;

namespace {

// Control characters cannot stand in a node's number or in a pointer, so no file has these.
constexpr std::string_view kReference = "\x01lodestone-node:";
constexpr std::string_view kPointer = "\x02lodestone-node:";
// The same as dumped.
constexpr std::string_view kDumpedReference = "\"\\u0001lodestone-node:";
constexpr std::string_view kDumpedPointer = "\\u0002lodestone-node:";

} // namespace

std::string shortestNumber(float value) {
    std::array<char, 32> digits{};
    // -0 would be an integer token without a fraction, which some readers turn into 0.
    const float written = value == 0.0f ? 0.0f : value;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), written).ptr;
    return {digits.data(), end};
}

std::string fixedWidthNumber(float value, std::size_t width) {
    const std::string text = shortestNumber(value);
    assert(text.size() <= width);
    return std::string(width - std::min(width, text.size()), ' ') + text;
}

std::string dumpJson(const json& value) {
    return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string dumpMembers(const json& object) {
    const std::string text = dumpJson(object);
    assert(text.size() >= 2 && text.front() == '{');
    return text.substr(1, text.size() - 2);
}

json nodeReference(std::uint32_t node) {
    return std::string(kReference) + std::to_string(node) + ";";
}

std::string nodePointer(std::uint32_t node) {
    return std::string(kPointer) + std::to_string(node) + ";";
}

Fragment::Fragment(const std::string& text) {
    std::size_t at = 0;
    while (at < text.size()) {
        const std::size_t reference = text.find(kDumpedReference, at);
        const std::size_t pointer = text.find(kDumpedPointer, at);
        const std::size_t found = std::min(reference, pointer);
        Piece piece;
        piece.text = text.substr(at, found == std::string::npos ? found : found - at);
        at = text.size();
        if (found != std::string::npos) {
            const bool quoted = found == reference;
            const std::size_t mark = quoted ? kDumpedReference.size() : kDumpedPointer.size();
            const char* const digits = text.data() + found + mark;
            const auto parsed = std::from_chars(digits, text.data() + text.size(), piece.node);
            piece.has_node = true;
            at = static_cast<std::size_t>(parsed.ptr - text.data()) + (quoted ? 2 : 1);
        }
        pieces_.push_back(std::move(piece));
    }
}

} // namespace lodestone
