#pragma once
#include "scene/result.h"

#include <nlohmann/json_fwd.hpp>

namespace lodestone {

// Checks the version and that every property of core glTF 2.0 has its JSON type, its length, and
// that every index is in range of the list it points into; extensions are not looked into.
// After it the reader may take types for granted. Errors: BadInput, message without file name.
Result<void> validateDocument(const nlohmann::json& document);

} // namespace lodestone
