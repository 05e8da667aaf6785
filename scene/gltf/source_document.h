#pragma once
// What a glTF file holds beside geometry and instances, kept for the way back out. Internal to
// scene/: the JSON library's header is heavy and no room outside needs it.
#include "scene/scene.h"

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

namespace lodestone {

// The document a Scene came from, or one made up for a scene that never was glTF.
//
// Scene and document agree thus:
//  - "materials", "images", "cameras", "skins" have the order and number of the Scene's lists
//    (cameras: one Scene::Camera for each *node* with a camera, see Node::camera).
//  - Submesh::primitives[p] belongs to "primitives"[p] of its mesh; primitives that cannot be drawn
//    are taken out of both (and noted).
//  - Geometry comes from the Scene alone: accessors that primitives refer to may be absent here.
//  - An image has "uri" (external file or data URI) or "bufferView", or neither: then its bytes are
//    in Scene::images[i].bytes and are to be embedded.
struct SourceDocument { // NOLINT(bugprone-exception-escape): json moves without throwing
    nlohmann::json json;
    // [json.buffers] resolved bytes of each; copies of a document share them.
    std::shared_ptr<std::vector<std::vector<std::byte>>> buffers =
        std::make_shared<std::vector<std::vector<std::byte>>>();
    std::filesystem::path folder;               // where external files lie
    std::vector<std::uint32_t> mesh_of_submesh; // [scene.submeshes] index into json.meshes
    std::vector<std::uint32_t> node_of_node;    // [scene.nodes] index into json.nodes
};

} // namespace lodestone
