#pragma once
#include <cstdint>

namespace lodestone {

// What the schedule minimises per step.
enum class Ordering : std::uint8_t {
    Triangle, // cost per instanced triangle removed
    Byte,     // cost per byte saved
    Cost,     // cost alone: the paper's literal order
};

// Where a LOD should end: the first position at or below the target, never above it.
struct Target {
    enum class Kind : std::uint8_t {
        Ratio,     // of the scene's instanced triangles, 0..1
        Triangles, // instanced triangles
        Bytes,     // exported size with the byte model's options
        Error,     // estimated, % of the diagonal
    };
    Kind kind = Kind::Ratio;
    double value = 1.0;
};

} // namespace lodestone
