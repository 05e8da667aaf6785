#pragma once
// A lane on its way through its LODs without popping: its vertices slide from LOD to LOD.
// Main thread only.
#include "simplify/geomorph.h"
#include "simplify/lod_source.h"

namespace lodestone {

class LaneSlide {
public:
    // What the lane shows at a share of the full scene's triangles (> 0, at most 1): somewhere
    // between two of the source's LODs, a fifth of the triangles apart. A continuous function of
    // the ratio but for instances, which vanish where the next two LODs begin. Its position is the
    // finer LOD's. Null: the source has no geomorphs.
    // Cost: O(what moves), and two read-outs where the next two LODs begin.
    std::shared_ptr<const Lod> at(const LodSourcePtr& source, double ratio);

private:
    LodSourcePtr source_; // of geomorph_
    double level_ = -1.0; // the finer LOD has kLevelRatio to the power of it
    Geomorph geomorph_;
};

} // namespace lodestone
