#pragma once
// A number at each vertex that a view can show as colour: an attribute of one float under this
// name. Never part of a file.
#include <string_view>

namespace lodestone {

inline constexpr std::string_view kVertexValueSemantic = "_LODESTONE_VALUE";

} // namespace lodestone
