#pragma once
// Meshes with every defect that files bring, and what any of them must reach.
#include "scene/scene.h"

namespace lodestone::meshes {

// More than 1,000 triangles, damaged in ways that the seed picks: turned over, doubled, without
// area, with T-junctions, with corners that belong elsewhere; of one part or of thousands.
GeometryPtr damagedMesh(unsigned seed);

// Fails unless Wild without floors, all instances expanded, reaches a thousandth of the triangles
// with finite vertices and sound indices.
void expectWildReachesAThousandth(const ScenePtr& scene);

} // namespace lodestone::meshes
