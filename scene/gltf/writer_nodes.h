#pragma once
// Plans the node hierarchy and the scenes of an export.
#include "scene/gltf/export_plan.h"

#include <set>

namespace lodestone {

// One NodePlan for each node of the document, in its order.
// document: the source's, references already rewritten. wanted: nodes that something refers to.
void planNodes(ExportPlan& plan, nlohmann::json& document, const std::set<std::uint32_t>& wanted);

// Members of a node but children, mesh, extensions and what only goes with a mesh.
nlohmann::json nodeBody(const nlohmann::json& entry);

// Fills scenes and the lists of children. added_roots: nodes that are not in the document and
// belong to the drawn scene.
void planScenes(ExportPlan& plan,
                const nlohmann::json& document,
                const std::vector<std::uint32_t>& added_roots);

} // namespace lodestone
