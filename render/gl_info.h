#pragma once
// Inside render/ only.
#include "render/gl.h"
#include "render/gl_context.h"

namespace lodestone {

// Loads the functions for the current context and asks what it is. Errors: Failed when the driver
// lacks OpenGL or it is older than 3.3.
Result<GlInfo> loadContext(GlProcLookup lookup);

} // namespace lodestone
