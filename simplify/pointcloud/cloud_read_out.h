#pragma once
// From a surface to the geometry of a LOD.
#include "scene/lod.h"
#include "simplify/pointcloud/cloud_surface.h"

namespace lodestone {

// Geometry of a submesh, [primitives]. Attributes, morph targets: those of the wedges that are
// left, in the file's order. Primitives that are no triangle lists are the submesh's own.
// O(faces + wedges).
std::vector<GeometryPtr>
readOutSurface(const CloudSurface& surface, const Submesh& submesh, const Complex& complex);

// The counts of that, [primitives], without making it. O(faces + wedges).
std::vector<PrimitiveShape>
shapeOfSurface(const CloudSurface& surface, const Submesh& submesh, const Complex& complex);

} // namespace lodestone
