#pragma once
// Modules that npm has installed.
#include "scene/result.h"

#include <string>

namespace lodestone::bench {

// The version of a module in a node_modules folder. Errors: Failed if it, or node, is not there.
Result<std::string> npmVersion(const std::string& npm, const std::string& module);

} // namespace lodestone::bench
