#pragma once
// Inside render/ only.
#include "render/gl_context.h"

namespace lodestone {

// Asks the current context. Errors: Failed when it is older than 3.3.
Result<GlInfo> queryGlInfo();

} // namespace lodestone
