#pragma once
// KHR_mesh_quantization: on which grid an export puts the positions of each submesh, and in which
// type it stores each attribute. The way back goes into the transforms of nodes and instances.
#include "scene/export.h"

#include <nlohmann/json.hpp>
#include <set>

namespace lodestone {

// position = offset + step * stored number
struct PositionGrid {
    glm::dvec3 offset{0.0};
    double step = 0.0; // a power of two, so that scales keep their digits; 0: floats are stored
};

// offset and step as a transform.
glm::dmat4 gridMatrix(const PositionGrid& grid);
// Whether numbers of 16 bits reach all of the bounds.
bool covers(const PositionGrid& grid, const Bounds& bounds);

// Bounds of each submesh; `merged` for those without vertices (of an expanded scene's skeleton).
std::vector<Bounds> submeshBounds(const Scene& scene, const Bounds& merged);

// One grid for each submesh, around its bounds (empty: no grid) with an eighth to spare. Floats
// stay where the grid's transform has no place: skins, morph targets, rows outside of the drawn
// scene, positions that the file has quantised already.
// Quantize uses all 16 bits; Meshopt as many as 2^-16 of the scene's diagonal asks for, 10 to 14.
std::vector<PositionGrid>
planGrids(const Scene& scene, Compression compression, std::span<const Bounds> bounds);

// Length of the diagonal of the boxes around all instances: never less than that of the scene, for
// tolerances. O(vertices + instances).
double boxDiagonal(const Scene& scene);

struct StoredType {
    ComponentType type = ComponentType::Float32;
    bool normalized = false;
};

// The type an export stores an attribute in: floats become smaller ones where their values allow.
StoredType storedType(const Attribute& attribute, Compression compression);
// Rounds to the stored type; a copy if it is its own already.
Attribute storedAttribute(const Attribute& attribute, const StoredType& stored);

// The number that the shortest text of its float stands for: no digits that a float does not have.
double shortNumber(double value);

// Puts the grids into the transforms of the document's nodes that draw such a mesh; where a node's
// transform has another duty, a child is appended that draws in its place.
// references: nodes that something refers to. Returns for each former node the one that draws.
std::vector<std::uint32_t> applyGrids(nlohmann::json& document,
                                      const Scene& scene,
                                      std::span<const PositionGrid> grids,
                                      const std::set<std::uint32_t>& references);

} // namespace lodestone
