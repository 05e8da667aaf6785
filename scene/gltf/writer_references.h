#pragma once
// Finds what a glTF document refers to by number outside meshes, node hierarchy and scenes:
// animations, skins, and extensions, unknown ones by the usual names of their keys.
#include <functional>
#include <nlohmann/json.hpp>

namespace lodestone {

struct ReferenceVisitor {
    std::function<void(nlohmann::json&)> node;          // a number
    std::function<void(nlohmann::json&)> node_pointer;  // a string "/nodes/12/..."
    std::function<void(nlohmann::json&)> accessor;      // a number
    std::function<void(nlohmann::json&)> skin_accessor; // a number; empty: as accessor
    std::function<void(nlohmann::json&)> buffer_view;   // a number
};

constexpr const char* kGpuInstancing = "EXT_mesh_gpu_instancing";

// Calls the visitor for every reference in animations, skins and all extensions but
// EXT_mesh_gpu_instancing and compression. Numbers that are out of any range are visited too.
// In unknown extensions the keys node, nodes, accessor, bufferView (and the property table's
// values, arrayOffsets, stringOffsets) are taken as references: a convention, not a rule.
void visitReferences(nlohmann::json& document, const ReferenceVisitor& visitor);

// Attributes, indices and morph targets of every primitive of a mesh.
void visitMeshAccessors(nlohmann::json& mesh, const ReferenceVisitor& visitor);

} // namespace lodestone
