#pragma once
// Plans meshes and images of an export.
#include "scene/gltf/export_plan.h"

namespace lodestone {

// Fills meshes, strides, stream and content counts, SubmeshPlan::mesh.
// document: the source's, references already rewritten; meshes are consumed.
void planMeshes(ExportPlan& plan, nlohmann::json& document);

// Gives every image a buffer view (.glb) or a file (.gltf) and rewrites the document's entries.
void planImages(ExportPlan& plan, nlohmann::json& document);

} // namespace lodestone
