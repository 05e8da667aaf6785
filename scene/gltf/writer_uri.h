#pragma once
// File names as glTF writes them.
#include <string>
#include <string_view>

namespace lodestone {

bool isUnreserved(char c); // stands for itself in a URI path
std::string percentDecoded(std::string_view uri);
std::string percentEncoded(std::string_view text);

} // namespace lodestone
