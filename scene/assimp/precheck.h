#pragma once
// What assimp trusts a file with and should not: looked at before assimp sees it. All messages are
// without file name; all errors BadInput.
#include "scene/result.h"

#include <string_view>

namespace lodestone {

// bytes: the whole file. extension: lower case, with dot; formats without a check pass.
Result<void> precheck(std::string_view extension, std::string_view bytes);

// Refuses entity declarations (they can grow exponentially), encodings other than UTF-8, elements
// nested too deeply for a recursive reader, and node instances that contain themselves or unfold to
// more nodes than can be held.
Result<void> checkCollada(std::string_view xml);

// The header is well-formed, every element it announces is there and every face refers to vertices
// that exist.
Result<void> checkPly(std::string_view bytes);

// A binary file holds the triangles that its count field announces.
Result<void> checkStl(std::string_view bytes);

} // namespace lodestone
