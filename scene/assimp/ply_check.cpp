#include "scene/assimp/precheck.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace lodestone {

namespace {

enum class Encoding : std::uint8_t { Ascii, LittleEndian, BigEndian };

struct Type {
    std::size_t bytes = 0;
    bool is_signed = false;
    bool is_float = false;
};

struct Property {
    std::string name;
    std::optional<Type> count_type; // of a list
    Type type;
};

struct Element {
    std::string name;
    std::uint64_t count = 0;
    std::vector<Property> properties;
};

struct Header {
    Encoding encoding = Encoding::Ascii;
    std::vector<Element> elements;
    std::string_view body;
};

std::optional<Type> typeNamed(std::string_view name) {
    struct Named {
        std::string_view name;
        Type type;
    };

    static constexpr std::array<Named, 16> kTypes{{{"char", {1, true, false}},
                                                   {"int8", {1, true, false}},
                                                   {"uchar", {1, false, false}},
                                                   {"uint8", {1, false, false}},
                                                   {"short", {2, true, false}},
                                                   {"int16", {2, true, false}},
                                                   {"ushort", {2, false, false}},
                                                   {"uint16", {2, false, false}},
                                                   {"int", {4, true, false}},
                                                   {"int32", {4, true, false}},
                                                   {"uint", {4, false, false}},
                                                   {"uint32", {4, false, false}},
                                                   {"float", {4, true, true}},
                                                   {"float32", {4, true, true}},
                                                   {"double", {8, true, true}},
                                                   {"float64", {8, true, true}}}};
    for (const Named& named : kTypes)
        if (named.name == name)
            return named.type;
    return std::nullopt;
}

std::vector<std::string_view> wordsOf(std::string_view line) {
    std::vector<std::string_view> words;
    std::size_t at = 0;
    while ((at = line.find_first_not_of(" \t\r", at)) != std::string_view::npos) {
        const std::size_t end = std::min(line.find_first_of(" \t\r", at), line.size());
        words.push_back(line.substr(at, end - at));
        at = end;
    }
    return words;
}

std::optional<Property> propertyOf(const std::vector<std::string_view>& words) {
    Property property;
    const bool is_list = words.size() == 5 && words[1] == "list";
    if (!is_list && words.size() != 3)
        return std::nullopt;
    const std::optional<Type> type = typeNamed(words[is_list ? 3 : 1]);
    if (is_list)
        property.count_type = typeNamed(words[2]);
    if (!type || (is_list && (!property.count_type || property.count_type->is_float)))
        return std::nullopt;
    property.type = *type;
    property.name = words.back();
    return property;
}

// One line of the header. False if it is not understood.
bool readHeaderLine(const std::vector<std::string_view>& words, Header& header, bool& has_format) {
    const std::string_view keyword = words.front();
    if (keyword == "comment" || keyword == "obj_info")
        return true;
    if (keyword == "format" && words.size() >= 2 && !has_format) {
        has_format = words[1] == "ascii" || words[1] == "binary_little_endian" ||
                     words[1] == "binary_big_endian";
        header.encoding = words[1] == "ascii"                  ? Encoding::Ascii
                          : words[1] == "binary_little_endian" ? Encoding::LittleEndian
                                                               : Encoding::BigEndian;
        return has_format;
    }
    if (keyword == "element" && words.size() == 3) {
        Element element;
        element.name = words[1];
        const char* end = words[2].data() + words[2].size();
        const auto [stop, error] = std::from_chars(words[2].data(), end, element.count);
        header.elements.push_back(std::move(element));
        return error == std::errc{} && stop == end;
    }
    if (keyword == "property" && !header.elements.empty()) {
        std::optional<Property> property = propertyOf(words);
        if (property)
            header.elements.back().properties.push_back(std::move(*property));
        return property.has_value();
    }
    return false;
}

Result<Header> readHeader(std::string_view bytes) {
    Header header;
    bool has_format = false;
    if (!bytes.starts_with("ply"))
        return badInput("does not start as a PLY file; it is of another format");
    for (std::size_t at = 0; at < bytes.size();) {
        const std::size_t end = std::min(bytes.find_first_of("\r\n", at), bytes.size());
        const std::string_view line = bytes.substr(at, end - at);
        at = end + (bytes.substr(end).starts_with("\r\n") ? 2 : 1);
        const std::vector<std::string_view> words = wordsOf(line);
        if (words.empty() || line == "ply")
            continue;
        if (words.front() == "end_header") {
            if (!has_format)
                return badInput("header names no format; export it again");
            header.body = bytes.substr(std::min(at, bytes.size()));
            return header;
        }
        if (!readHeaderLine(words, header, has_format))
            return badInput("header line '" + std::string(line.substr(0, 60)) +
                            "' is not understood; export it again");
    }
    return badInput("header has no end; the file is cut off, export it again");
}

// Reads numbers one after the other.
class BodyReader {
public:
    explicit BodyReader(const Header& header) : body_(header.body), encoding_(header.encoding) {}

    // The next value, meaningful if it is a whole number; false if it is not there.
    bool next(const Type& type, std::int64_t& value) {
        return encoding_ == Encoding::Ascii ? nextWord(value) : nextBinary(type, value);
    }

    bool skip(std::size_t bytes) { // binary
        if (bytes > remaining())
            return false;
        at_ += bytes;
        return true;
    }

    bool isAscii() const { return encoding_ == Encoding::Ascii; }

    std::size_t remaining() const { return body_.size() - at_; }

private:
    bool nextWord(std::int64_t& value) {
        while (at_ < body_.size() && std::isspace(static_cast<unsigned char>(body_[at_])) != 0)
            ++at_;
        const std::size_t begin = at_;
        while (at_ < body_.size() && std::isspace(static_cast<unsigned char>(body_[at_])) == 0)
            ++at_;
        value = std::numeric_limits<std::int64_t>::min(); // a word that starts with no whole number
        std::from_chars(body_.data() + begin, body_.data() + at_, value);
        return at_ > begin;
    }

    bool nextBinary(const Type& type, std::int64_t& value) {
        if (type.bytes > remaining())
            return false;
        std::uint64_t raw = 0;
        for (std::size_t i = 0; i < type.bytes; ++i) {
            const std::size_t from = encoding_ == Encoding::LittleEndian ? type.bytes - 1 - i : i;
            raw = (raw << 8) | static_cast<unsigned char>(body_[at_ + from]);
        }
        at_ += type.bytes;
        value = static_cast<std::int64_t>(raw);
        if (type.is_signed && !type.is_float && type.bytes < 8 &&
            ((raw >> (8 * type.bytes - 1)) & 1) != 0)
            value -= std::int64_t{1} << (8 * type.bytes);
        return true;
    }

    std::string_view body_;
    Encoding encoding_;
    std::size_t at_ = 0;
};

// The least that one entry of an element takes.
std::size_t leastBytes(const Element& element, bool ascii) {
    std::size_t bytes = 0;
    for (const Property& property : element.properties)
        bytes += ascii ? 2 : property.count_type.value_or(property.type).bytes;
    return bytes;
}

tl::unexpected<Error> cutOff(const Element& element, std::uint64_t entry) {
    return badInput("'" + element.name + "' " + std::to_string(entry) + " of " +
                    std::to_string(element.count) +
                    " is not there or damaged; the file is cut off, export it again");
}

Result<void> checkEntry(const Element& element,
                        std::uint64_t entry,
                        std::uint64_t vertex_count,
                        BodyReader& reader) {
    std::int64_t value = 0;
    for (const Property& property : element.properties) {
        std::int64_t count = 1;
        if (property.count_type && (!reader.next(*property.count_type, count) || count < 0 ||
                                    static_cast<std::uint64_t>(count) > reader.remaining()))
            return cutOff(element, entry);
        const bool refers = property.count_type && element.name == "face" &&
                            (property.name == "vertex_indices" || property.name == "vertex_index");
        for (std::int64_t i = 0; i < count; ++i) {
            if (!reader.next(property.type, value))
                return cutOff(element, entry);
            if (refers && (value < 0 || static_cast<std::uint64_t>(value) >= vertex_count))
                return badInput("face " + std::to_string(entry) + " refers to vertex " +
                                std::to_string(value) + " of " + std::to_string(vertex_count) +
                                "; repair the mesh and export again");
        }
    }
    return {};
}

} // namespace

Result<void> checkPly(std::string_view bytes) {
    const Result<Header> header = readHeader(bytes);
    if (!header)
        return tl::unexpected(header.error());
    BodyReader reader(*header);
    std::uint64_t vertex_count = 0;
    for (const Element& element : header->elements)
        if (element.name == "vertex")
            vertex_count = element.count;
    for (const Element& element : header->elements) {
        const std::size_t least = leastBytes(element, reader.isAscii());
        // The last word of a text needs no space behind it.
        if (element.count == 0)
            continue;
        if (least == 0 || element.count > (reader.remaining() + 1) / least)
            return badInput("announces " + std::to_string(element.count) + " of element '" +
                            element.name + "', more than the file can hold; export it again");
        const bool fixed = std::ranges::none_of(
            element.properties, [](const Property& p) { return p.count_type.has_value(); });
        if (fixed && !reader.isAscii()) {
            if (!reader.skip(least * element.count))
                return cutOff(element, element.count - 1);
            continue;
        }
        for (std::uint64_t entry = 0; entry < element.count; ++entry)
            if (Result<void> ok = checkEntry(element, entry, vertex_count, reader); !ok)
                return ok;
    }
    return {};
}

} // namespace lodestone
