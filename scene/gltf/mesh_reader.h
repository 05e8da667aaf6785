#pragma once
#include "scene/gltf/accessor_reader.h"

namespace lodestone {

// Fills Scene::submeshes, one a mesh of the document, and SourceDocument::mesh_of_submesh.
//
// Strips and fans become triangle lists (the degenerate triangles that join strips are dropped);
// primitives without indices get 0, 1, 2, ...; lists are cut to whole triangles or lines.
// Primitives with the same accessors share one Geometry. A primitive that uses part of a vertex
// list it shares with others gets the vertices it uses alone, in the same order.
// A primitive without positions, or too short to draw, is dropped from scene and document with a
// note; a mesh left without primitives is dropped from the document and its nodes.
// Errors: BadInput naming mesh and primitive; Cancelled.
Result<void> readMeshes(const ReadContext& context, AccessorReader& accessors);

} // namespace lodestone
