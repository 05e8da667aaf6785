#pragma once
#include "scene/result.h"
#include "scene/scene.h"

#include <functional>

struct aiMesh;

namespace lodestone {

struct MeshOptions {
    bool keep_normals = true;
};

// The triangles, lines and points of a mesh, one primitive each; bit-equal vertices of triangles
// and lines joined, unused ones dropped. Polygons must have been triangulated. Texture coordinates
// get glTF's origin (v turned over); colours that are whole 255ths become normalised bytes.
// material_of maps assimp's material index. Errors: BadInput (message without file name): positions
// that are not finite, faces that refer to no vertex.
Result<std::vector<Primitive>>
convertMesh(const aiMesh& mesh,
            const MeshOptions& options,
            const std::function<std::uint32_t(std::uint32_t)>& material_of);

} // namespace lodestone
