#pragma once
#include "scene/gltf/accessor_reader.h"

namespace lodestone {

// A primitive as read: nothing of it shared or compacted yet.
struct PrimitiveData {
    Geometry geometry;
    PrimitiveMode mode = PrimitiveMode::Triangles;
    ComponentType position_type = ComponentType::Float32;
    bool position_normalized = false;
};

// Reads one primitive of a validated document. name: for notes ("mesh 3 'leaf' primitive 0").
// Result without a value: nothing to draw, a note says why.
// Errors: BadInput, message without file and primitive name.
Result<std::optional<PrimitiveData>> readPrimitive(const nlohmann::json& primitive,
                                                   AccessorReader& accessors,
                                                   const std::string& name,
                                                   std::vector<std::string>& notes);

// Drops vertices that no index refers to; keeps the order of the others.
void dropUnusedVertices(Geometry& geometry);

} // namespace lodestone
