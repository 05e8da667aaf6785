#include "scene/gltf/uri.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

namespace lodestone {

namespace {

int hexDigit(char c) {
    if (c >= '0' && c <= '9')
        return c - '0';
    if (c >= 'a' && c <= 'f')
        return c - 'a' + 10;
    if (c >= 'A' && c <= 'F')
        return c - 'A' + 10;
    return -1;
}

std::string percentDecoded(std::string_view text) {
    std::string decoded;
    decoded.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '%' && i + 2 < text.size()) {
            const int high = hexDigit(text[i + 1]);
            const int low = hexDigit(text[i + 2]);
            if (high >= 0 && low >= 0) {
                decoded.push_back(static_cast<char>(high * 16 + low));
                i += 2;
                continue;
            }
        }
        decoded.push_back(text[i]);
    }
    return decoded;
}

std::array<int, 256> makeBase64Table() {
    std::array<int, 256> table;
    table.fill(-1);
    const std::string_view digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (std::size_t i = 0; i < digits.size(); ++i)
        table[static_cast<unsigned char>(digits[i])] = static_cast<int>(i);
    table[static_cast<unsigned char>('-')] = 62; // the URL-safe alphabet
    table[static_cast<unsigned char>('_')] = 63;
    return table;
}

std::optional<std::vector<std::byte>> decodeBase64(std::string_view text) {
    static const std::array<int, 256> table = makeBase64Table();
    std::vector<std::byte> bytes;
    bytes.reserve(text.size() / 4 * 3 + 3);
    std::uint32_t bits = 0;
    int bit_count = 0;
    for (const char c : text) {
        if (c == '=')
            break;
        if (std::isspace(static_cast<unsigned char>(c)) != 0)
            continue;
        const int digit = table[static_cast<unsigned char>(c)];
        if (digit < 0)
            return std::nullopt;
        bits = (bits << 6) | static_cast<std::uint32_t>(digit);
        bit_count += 6;
        if (bit_count >= 8) {
            bit_count -= 8;
            bytes.push_back(static_cast<std::byte>((bits >> bit_count) & 0xFFu));
        }
    }
    return bytes;
}

bool hasScheme(std::string_view uri) {
    const std::size_t colon = uri.find(':');
    return colon != std::string_view::npos && colon < uri.find('/');
}

} // namespace

bool isDataUri(std::string_view uri) {
    return uri.starts_with("data:");
}

Result<DataUri> decodeDataUri(std::string_view uri) {
    const std::size_t comma = uri.find(',');
    if (!isDataUri(uri) || comma == std::string_view::npos)
        return badInput("data URI has no comma: re-export the file");
    std::string_view head = uri.substr(5, comma - 5);
    const std::string_view body = uri.substr(comma + 1);
    const bool base64 = head.ends_with(";base64");
    DataUri result;
    result.mime_type = std::string(head.substr(0, head.find(';')));
    if (base64) {
        std::optional<std::vector<std::byte>> bytes = decodeBase64(body);
        if (!bytes)
            return badInput("data URI is not valid base64: re-export the file");
        result.bytes = std::move(*bytes);
    } else {
        const std::string text = percentDecoded(body);
        result.bytes.resize(text.size());
        std::ranges::transform(
            text, result.bytes.begin(), [](char c) { return static_cast<std::byte>(c); });
    }
    return result;
}

Result<std::filesystem::path> resolveBeside(const std::filesystem::path& folder,
                                            std::string_view uri) {
    namespace fs = std::filesystem;
    const std::string decoded = percentDecoded(uri);
    const std::string quoted = "'" + decoded.substr(0, 120) + "'";
    if (decoded.empty() || decoded.find('\0') != std::string::npos)
        return badInput("refers to a file by an empty name: re-export the file");
    const fs::path relative(decoded);
    if (hasScheme(decoded) || relative.is_absolute() || decoded.find('\\') == 0)
        return badInput(quoted + " is not in the model's folder: put the file beside the model");
    std::error_code error;
    const fs::path root = fs::weakly_canonical(folder.empty() ? fs::path(".") : folder, error);
    fs::path target = error ? fs::path() : fs::weakly_canonical(root / relative, error);
    if (error)
        return badInput(quoted + " cannot be resolved: check the path");
    const auto [root_end, ignored] =
        std::mismatch(root.begin(), root.end(), target.begin(), target.end());
    if (root_end != root.end())
        return badInput(quoted + " leaves the model's folder: put the file beside the model");
    return target;
}

} // namespace lodestone
