#pragma once
// How much of its size a submesh keeps as long as it stands in several places.
#include "scene/scene.h"

#include <array>

namespace lodestone {

struct ShapeMeasure {
    Bounds bounds;
    double area = 0.0;

    // A face that is there.
    void add(const std::array<glm::dvec3, 3>& corners);
};

// The shares that must stay, 0..1.
struct ShapeShares {
    double extent = 0.0; // of every axis but a thin one
    double area = 0.0;
};

// Whether that much of `whole` is left. A leaf's sag is not its size: an axis less than a quarter
// as long as both others does not count. The height of a flat house does.
bool keepsShape(const ShapeMeasure& now, const ShapeMeasure& whole, const ShapeShares& shares);

} // namespace lodestone
