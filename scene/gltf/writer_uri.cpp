#include "scene/gltf/writer_uri.h"

#include <cctype>
#include <charconv>

namespace lodestone {

bool isUnreserved(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
           std::string_view("-._~/").find(c) != std::string_view::npos;
}

std::string percentDecoded(std::string_view uri) {
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        unsigned int code = 0;
        const char* const digits = uri.data() + i + 1;
        if (uri[i] == '%' && i + 2 < uri.size() &&
            std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2) {
            text += static_cast<char>(code);
            i += 2;
        } else {
            text += uri[i];
        }
    }
    return text;
}

std::string percentEncoded(std::string_view text) {
    constexpr std::string_view kHex = "0123456789ABCDEF";
    std::string uri;
    for (const char c : text) {
        if (isUnreserved(c)) {
            uri += c;
            continue;
        }
        const auto code = static_cast<unsigned char>(c);
        uri += '%';
        uri += kHex[code >> 4];
        uri += kHex[code & 15];
    }
    return uri;
}

} // namespace lodestone
