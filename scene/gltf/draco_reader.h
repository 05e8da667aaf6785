#pragma once
#include "scene/gltf/accessor_reader.h"

#include <map>

namespace lodestone {

// What KHR_draco_mesh_compression holds of a primitive, in the types that its accessors name.
struct DracoPrimitive {
    std::map<std::string, AccessorPtr> attributes; // by semantic; equal counts
    std::vector<std::uint32_t> indices;            // triangle list, < count
};

// Decodes the primitive's compressed data; nothing if it has none, or if its accessors have bytes
// of their own. The primitive has a POSITION.
// Errors: BadInput, message without file and primitive name.
Result<std::optional<DracoPrimitive>> readDraco(const nlohmann::json& primitive,
                                                const AccessorReader& accessors);

} // namespace lodestone
