#pragma once
// What attributes (normals, texture coordinates, colours) add to a collapse.
//
// Each face continues an attribute linearly over space, its gradient lying in the face. A wedge's
// error in it is the sum over its faces of area * (face's continuation - wedge's value)^2 (Hoppe
// 1999). With the value solved for, that is the area-weighted mean of the continuations, this
// splits into two parts without loss: a plain quadric of the position, which its vertex's quadric
// takes up, and area * (value - prediction)^2, where the prediction is linear in the position. Two
// wedges that merge then add exactly
//     a1 a2 / (a1 + a2) * (prediction 1 - prediction 2)^2 ,
// a plane of the position. So wedges keep four numbers an attribute value instead of a matrix, all
// sums are of squares, and nothing cancels.
#include "simplify/collapse/quadric.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace lodestone {

// The predictions of all wedges of a mesh. Values are in its units of length.
class WedgeQuadrics {
public:
    // Forgets all. value_count: values a wedge; 0: attributes do not count.
    void reset(std::size_t wedge_count, std::size_t value_count);

    bool active() const { return value_count_ > 0; }

    std::size_t valueCount() const { return value_count_; }

    // --- building: the values of all wedges, then all faces, then every wedge once

    void setValues(std::uint32_t wedge, std::span<const float> values); // [valueCount()]

    struct Face {
        std::array<Float3, 3> positions;
        std::array<std::uint32_t, 3> wedges;
        float weight = 0.0f; // area times instances, > 0
    };

    // Result: what the quadrics of its three vertices gain, relative to any of them.
    Quadric addFace(const Face& face);
    // Result: what the quadric of its vertex loses again.
    Quadric finish(std::uint32_t wedge);

    // --- collapsing

    // Moves a wedge with its vertex.
    void move(std::uint32_t wedge, Float3 by);
    // Merges two wedges at one place. Result: what the quadric there gains.
    Quadric merge(std::uint32_t into, std::uint32_t from);

    // The best value of a wedge where its vertex lies.
    float value(std::uint32_t wedge, std::size_t i) const {
        return lines_[wedge * value_count_ + i][3];
    }

    // Adds to a quadric about the middle of an edge what merging two wedges, one of each end,
    // costs. half: from the middle to second's end.
    void addMerge(QuadricOf<float>& sum,
                  std::uint32_t first,
                  std::uint32_t second,
                  const Vector3<float>& half) const;
    // The same for four edges; share: 1, or 0 where there is nothing to merge.
    void addMerges(QuadricOf<Float4>& sum,
                   const std::array<std::uint32_t, 4>& first,
                   const std::array<std::uint32_t, 4>& second,
                   const Vector3<Float4>& half,
                   const Float4& share) const;

    void prefetch(std::uint32_t wedge) const {
        __builtin_prefetch(lines_.data() + wedge * value_count_);
        __builtin_prefetch(weights_.data() + wedge);
    }

private:
    std::size_t value_count_ = 0;
    std::vector<float> weights_; // [wedges] of its faces
    std::vector<Float4> lines_;  // [wedges * value_count_] gradient, value at the vertex
};

} // namespace lodestone
