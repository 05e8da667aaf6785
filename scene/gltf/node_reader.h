#pragma once
#include "scene/gltf/accessor_reader.h"

namespace lodestone {

// Fills Scene::nodes (all nodes of the document, in its order; nodes outside the default scene have
// no parent and the identity), Scene::cameras (one for each node that has one) and
// Scene::instances (every draw of the default scene, EXT_mesh_gpu_instancing unfolded).
// The document's node graph is made a tree on the way (see makeNodeTree).
// readMeshes() comes before. Errors: BadInput naming the node.
Result<void> readNodes(const ReadContext& context, AccessorReader& accessors);

} // namespace lodestone
