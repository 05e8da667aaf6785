#pragma once
// A measured surface with its colours.
#include "simplify/measure/measured_side.h"
#include "simplify/measure/surface_color.h"

namespace lodestone {

// Lengths of colour differences, summed.
struct ColorSums {
    std::uint64_t count = 0;
    double sum = 0.0;

    void add(const ColorSums& other) {
        count += other.count;
        sum += other.sum;
    }

    void add(const glm::dvec3& difference) { add({1, glm::length(difference)}); }

    double mean() const { return sum / static_cast<double>(count); }
};

// colors: of the scene that the side draws. Both outlive it. Any thread.
struct ColoredSide {
    const MeasuredSide& side;
    const SurfaceColors& colors;

    // sRGB of a point of a piece's triangle.
    glm::dvec3 colorAt(std::uint32_t piece, std::size_t triangle, const glm::dvec3& weights) const {
        const SurfacePiece& drawn = side.pieces[piece];
        return colors.at(*drawn.geometry, drawn.material, triangle, weights);
    }

    // Of the point of the surface that is closest to a point of the frame.
    glm::dvec3 colorAt(const ClosestSurface::Hit& hit, const glm::dvec3& point) const {
        return colorAt(hit.piece,
                       side.surface.geometryTriangle(hit),
                       closestWeights(point, side.surface.triangle(hit)));
    }
};

} // namespace lodestone
