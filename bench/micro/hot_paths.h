#pragma once
// What must not become slower, each as one small benchmark on generated scenes.
#include "scene/result.h"

namespace lodestone::bench {

// Its time is what all others are told in: fixed work on fixed data, no code of ours.
constexpr const char* kReferenceKernel = "reference: sort and add up 20,000 floats";

// Makes the scenes and registers the reference and every hot path with Google Benchmark.
// Upload needs OpenGL; without it that one is left out, which the result says (empty: nothing).
// Errors: those of generating and simplifying.
Result<std::string> registerHotPaths();

} // namespace lodestone::bench
