#pragma once
// From what a method decided to a surface again: the "surface Delaunay" retriangulation.
#include "simplify/pointcloud/cloud_surface.h"

namespace lodestone {

// Indices remapped; faces with two corners at one vertex dropped; of changed faces of a primitive
// on the same three vertices: opposite ones cancel in pairs if one is folded over onto the other,
// of equal ones the first is kept. So a closed, consistently oriented surface gets no edge with
// exactly one face. Both sides stay of what the input has on both sides, and of what was thin and
// is flat now: a roof does not vanish. Wedges that became one keep the attributes of the wedge that
// lay nearest. complex: what the surface was made of. O(faces). Stops early where asked to; the
// surface is to be dropped then.
void applyMerges(CloudSurface& surface,
                 const Merges& merges,
                 const Complex& complex,
                 const JobContext& job);

// Flips edges to the Delaunay criterion in the faces that changed (and their borders), where the
// two faces are nearly in one plane, belong to one primitive and no seam runs between them.
// O(faces). Stops early where asked to.
void flipToDelaunay(CloudSurface& surface, const JobContext& job);

} // namespace lodestone
