#pragma once
#include <string>
#include <string_view>

namespace lodestone {

// A JSON string literal with its quotes; bytes that are not UTF-8 become U+FFFD.
std::string jsonText(std::string_view text);

} // namespace lodestone
