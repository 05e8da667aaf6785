#pragma once
#include "scene/gltf/read_context.h"

namespace lodestone {

// A node of the default scene and where it hangs.
struct TreeNode {
    std::uint32_t node = 0;       // index in json.nodes
    std::uint32_t parent = kNone; // the same, kNone for a root
};

// Brings the document's node graph into the shape glTF asks for and returns the nodes of the
// default scene, parents before children, in the file's order.
//  - no "scene": the first; no "scenes": all nodes that are nobody's child become one (noted).
//  - a node with several parents gets a copy of its subtree for each further one (noted), at most
//    200,000 copies in all.
// No recursion: any depth. Errors: BadInput for cycles, for nothing in the scene.
Result<std::vector<TreeNode>> makeNodeTree(const ReadContext& context);

// For each node, whether a scene other than the default one holds it.
std::vector<bool> nodesOfOtherScenes(const nlohmann::json& document);

} // namespace lodestone
