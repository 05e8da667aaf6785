#pragma once
// Rows of EXT_mesh_gpu_instancing: transforms as accessors store them.
#include "scene/gltf/export_plan.h"
#include "scene/scene_builder.h"

namespace lodestone {

// What a rotation may move.
struct RowReach {
    double distance = 0.0;  // of the mesh's farthest point from its origin, before the row's scale
    double tolerance = 0.0; // in the row's space
    glm::dvec3 center{0.0}; // of the mesh's box
    double radius = 0.0;    // half of its diagonal
};

// TRANSLATION, ROTATION and SCALE of the rows. Rotations and scales are left out where all of them
// are the identity. Rotations are normalised 16-bit integers where no point moves by more than the
// tolerance (their angle is off by 4e-5 rad at most), floats otherwise.
std::vector<GroupAttribute> rowAttributes(std::span<const Trs> rows, const RowReach& reach);

// ROTATION alone, by the same rule.
GroupAttribute rotationAttribute(std::span<const Trs> rows, const RowReach& reach);

// ROTATION in normalised 8-bit integers, and TRANSLATION moved so that the middle of each mesh
// stays where it was. Empty where a point would move by more than the tolerance, also in a viewer
// that takes the quaternion for one of unit length. An angle is off by 0.014 rad at most.
std::vector<GroupAttribute> coarseAttributes(std::span<const Trs> rows, const RowReach& reach);

// The scale that all rows have along all axes, taken out of them so that a node around them can
// have it instead; 1 if there is none.
double takeCommonScale(std::span<Trs> rows);

// TRANSLATION, ROTATION and SCALE by name, as floats or normalised integers of the same row count.
struct RowColumn {
    std::string name;
    Attribute values;
};

std::vector<Trs> rowTransforms(std::span<const RowColumn> columns, std::size_t row_count);

} // namespace lodestone
