#pragma once
// The only file that includes the OpenGL loader: glad where CMake finds it, else libepoxy.
#ifdef LODESTONE_USE_GLAD
#include <glad/glad.h>
#else
#include <epoxy/gl.h>
#endif

namespace lodestone {

using GlProc = void (*)();
using GlProcLookup = GlProc (*)(const char* name);

// Resolves the functions for the current context; epoxy resolves them by itself on first use.
// False: the driver lacks OpenGL.
inline bool loadGl([[maybe_unused]] GlProcLookup lookup) {
#ifdef LODESTONE_USE_GLAD
    static GlProcLookup current_lookup = nullptr;
    current_lookup = lookup;
    return gladLoadGLLoader(
               [](const char* name) { return reinterpret_cast<void*>(current_lookup(name)); }) != 0;
#else
    return true;
#endif
}

} // namespace lodestone
