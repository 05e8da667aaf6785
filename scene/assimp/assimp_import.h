#pragma once
#include "scene/job_context.h"
#include "scene/result.h"
#include "scene/scene.h"

#include <filesystem>

namespace lodestone {

// Reads .dae .3ds .obj .ply .stl .fbx. Instancing is kept: nodes that draw the same meshes share a
// submesh, and submeshes of equal content become one. +Y is up; COLLADA and FBX come out in metres.
// Polygons are triangulated, bit-equal vertices joined; points and lines stay. Normals only where
// the file has them (STL's are implied by its triangles and left out). Materials are double-sided.
// Files it refers to must lie in its folder or below; those missing are noted, as are lights,
// animations, skins and morph targets, which are left out.
// Errors: BadInput (unreadable, damaged, nothing to draw), Cancelled. Any thread.
Result<ScenePtr> importWithAssimp(const std::filesystem::path& path, const JobContext& job);

} // namespace lodestone
