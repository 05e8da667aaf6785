#pragma once
// How a scene is de-instanced: which parts merge, what the merged scene looks like without its
// vertices, and the vertices of a LOD. Internal to scene/; expandScene() is the public face.
#include "scene/job_context.h"
#include "scene/lod.h"
#include "scene/result.h"

namespace lodestone {

struct ExpandPart {
    std::uint32_t submesh = 0; // of the original scene
    std::uint32_t primitive = 0;
};

// One merged primitive: a submesh of its own in the expanded scene.
struct ExpandGroup {
    std::uint32_t material = kNone;
    std::vector<ExpandPart> parts;
};

struct Expansion {
    // The expanded scene; merged geometry has its attributes but no vertices yet.
    std::shared_ptr<Scene> skeleton;
    std::vector<ExpandGroup> groups;      // become submeshes first_merged + i of the skeleton
    std::uint32_t first_merged = 0;       // the submeshes before that stay apart
    std::vector<bool> merges;             // [original instances]
    std::vector<std::uint32_t> apart;     // [first_merged] original submesh
    std::vector<std::uint32_t> new_index; // [original instances] in the skeleton; kNone: merged
};

// Static triangle meshes without morph targets merge per material and set of attributes; whatever
// is skinned or moves, points and lines stay apart. A group of one submesh with nothing else bears
// its name, others that of their material. O(instances + document).
Expansion planExpansion(const Scene& scene);

// The scene as it is, and after its submeshes and instances the merged ones in which those of
// mergingSubmeshes() can be drawn instead: all stay apart, and as they were numbered.
Expansion planBesides(const Scene& scene);

// Submeshes of which every instance would merge. [scene.submeshes]
std::vector<bool> mergingSubmeshes(const Scene& scene);

// Counts of the expanded LOD. O(kept instances of submeshes that merge in part + primitives).
LodShape expandShape(const Expansion& expansion, const Scene& scene, const LodShape& shape);

// The LOD in world space: geometry for the skeleton's submeshes. Parallel, the same for any number
// of threads. Errors: Cancelled; Failed if that would be more vertices than fit.
Result<Lod>
expandLod(const Expansion& expansion, const Scene& scene, const Lod& lod, const JobContext& job);

// Counts what the submeshes of a LOD hold.
void countLod(Lod& lod);

// Vertices of one part transformed and appended at first_vertex and first_index of `to`, whose
// arrays are large enough. Different places of one geometry can be filled at the same time.
struct ExpandPlace {
    std::uint32_t first_vertex = 0;
    std::uint32_t first_index = 0;
};

void appendTransformed(Geometry& to,
                       const ExpandPlace& place,
                       const Geometry& from,
                       const glm::dmat4& transform);

// The document of the expanded scene: nodes that only drew merged instances are gone, one node for
// each group is added. Fills the skeleton's source, nodes and instances.
void expandDocument(Expansion& expansion, const Scene& scene);
// The same without taking anything out.
void extendDocument(Expansion& expansion, const Scene& scene);

} // namespace lodestone
