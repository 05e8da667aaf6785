#pragma once
// Small hand-made scenes for tests of every folder.
#include "scene/scene.h"

#include <span>

namespace lodestone::fixtures {

// Geometry with positions, unit NORMALs and TEXCOORD_0 taken from x and y.
GeometryPtr makeGeometry(std::vector<glm::vec3> positions, std::vector<std::uint32_t> indices);

// The same without attributes.
GeometryPtr makeBareGeometry(std::vector<glm::vec3> positions, std::vector<std::uint32_t> indices);

GeometryPtr triangleGeometry(); // (0,0,0) (1,0,0) (0,1,0)
GeometryPtr cubeGeometry();     // edge 1 about the origin, 24 vertices, 12 triangles, normals
// Unit square in xy at z = 0, quads_per_side^2 quads of two triangles, one vertex a corner.
GeometryPtr gridGeometry(std::uint32_t quads_per_side);

// One submesh of one primitive, one instance for each transform (the identity if there is none).
ScenePtr sceneOf(GeometryPtr geometry, std::span<const glm::dmat4> transforms = {});

ScenePtr triangleScene();
ScenePtr cubeScene();
// One submesh with two primitives: four sides in material "sides", top and bottom in "caps".
ScenePtr twoMaterialCubeScene();
ScenePtr gridScene(std::uint32_t quads_per_side);
// Cubes: as is, moved and turned, mirrored, sheared, flattened to 1 %, in this order.
ScenePtr awkwardInstancesScene();
// A quad with an embedded 2 x 2 PNG as base colour.
ScenePtr texturedQuadScene();
// count cubes in a row along x, named "cube 0", "cube 1", ...
ScenePtr cubeRowScene(std::uint32_t count);

} // namespace lodestone::fixtures
