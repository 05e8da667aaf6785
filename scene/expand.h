#pragma once
#include "scene/job_context.h"
#include "scene/result.h"
#include "scene/scene.h"

namespace lodestone {

// De-instances a scene: every instance's triangles transformed to world space, one submesh with one
// primitive per material (and per set of attributes), one instance with the identity transform.
// Skinned or animated nodes stay apart as they are; so do points and lines. Normals and tangents
// transformed rightly, mirrored instances get their winding turned. No welding across instances.
// The result is a full Scene with a source document of its own: it exports, renders and simplifies
// like any other. O(instanced vertices), parallel, deterministic. Errors: Cancelled.
Result<ScenePtr> expandScene(const Scene& scene, const JobContext& job);

} // namespace lodestone
