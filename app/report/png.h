#pragma once
#include "scene/result.h"
#include "simplify/measure/image_difference.h"

#include <string>

namespace lodestone {

// The bytes of a PNG file; alpha is dropped. Errors: Failed (memory), Usage for an empty picture.
Result<std::string> encodePng(const Picture& picture);

} // namespace lodestone
