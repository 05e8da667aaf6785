#pragma once
// Where emitted JSON goes: into a string (writing) or into a byte count (predicting). One emission
// logic is instantiated for both, so a prediction cannot differ from what is written.
#include <charconv>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lodestone {

// Decimal digits of a number.
constexpr std::uint64_t digitCount(std::uint64_t value) {
    std::uint64_t digits = 1;
    for (; value >= 10; value /= 10)
        ++digits;
    return digits;
}

// The fewest digits that read back as the same float.
std::string shortestNumber(float value);

// The shortest text that reads back as the same float, padded with spaces on the left to `width`
// characters (JSON allows it), so that a size never depends on a value. value: finite.
std::string fixedWidthNumber(float value, std::size_t width);

class CountingSink {
public:
    void text(std::string_view text) { size_bytes_ += text.size(); }

    void number(std::uint64_t value) { size_bytes_ += digitCount(value); }

    void fixedNumber(float /*value*/, std::size_t width) { size_bytes_ += width; }

    std::uint64_t sizeBytes() const { return size_bytes_; }

private:
    std::uint64_t size_bytes_ = 0;
};

class StringSink {
public:
    void text(std::string_view text) { text_ += text; }

    void number(std::uint64_t value) { text_ += std::to_string(value); }

    void fixedNumber(float value, std::size_t width) { text_ += fixedWidthNumber(value, width); }

    std::string take() { return std::move(text_); }

private:
    std::string text_;
};

// JSON text without line breaks; bytes that are not UTF-8 are replaced instead of thrown at.
std::string dumpJson(const nlohmann::json& value);
// The members of an object without its braces: "a":1,"b":2
std::string dumpMembers(const nlohmann::json& object);

// Constant JSON text with references to nodes, whose numbers are only known when a LOD is laid out.
class Fragment {
public:
    Fragment() = default;
    // text: as dumped, references as made by nodeReference() and nodePointer().
    explicit Fragment(const std::string& text);

    bool empty() const { return pieces_.empty(); }

    template <class Sink>
    void emit(Sink& sink, std::span<const std::uint32_t> node_index) const {
        for (const Piece& piece : pieces_) {
            sink.text(piece.text);
            if (piece.has_node)
                sink.number(node_index[piece.node]);
        }
    }

private:
    struct Piece {
        std::string text;
        std::uint32_t node = 0; // the number that follows the text
        bool has_node = false;
    };

    std::vector<Piece> pieces_;
};

// Stands for a node's number until it is known: a value of its own, or a part of a string value.
nlohmann::json nodeReference(std::uint32_t node);
std::string nodePointer(std::uint32_t node);

// Writes a comma before every item but the first.
template <class Sink>
class Separator {
public:
    explicit Separator(Sink& sink) : sink_(sink) {}

    void next() {
        if (!first_)
            sink_.text(",");
        first_ = false;
    }

private:
    Sink& sink_;
    bool first_ = true;
};

} // namespace lodestone
