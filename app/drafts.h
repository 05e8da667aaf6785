#pragma once
// Which coarser LOD stands in for a lane while the camera moves, where drawing the lane's own takes
// too long for a moving picture. Main thread; no GL.
#include "app/document.h"

#include <map>

namespace lodestone {

class Drafts {
public:
    // What a frame has for pictures; a LOD that costs no more needs no draft.
    static constexpr double kPicturesMs = 25.0;

    // ms_per_triangle: guess for lanes that were never drawn.
    explicit Drafts(double ms_per_triangle) : ms_per_triangle_(ms_per_triangle) {}

    // The LOD to draw: of the lane's scene, read out of its own edge-collapse source or of another
    // lane's that simplifies the same scene. Null: the lane's own LOD is quick enough to draw, or
    // there is nothing coarser. The same pointer until source or wanted size change.
    std::shared_ptr<const Lod> draftOf(const Document& document, const Lane& lane);

    // What drawing cost; 0: unknown. The size of drafts follows it.
    void setCosts(const Lane& lane, double full_ms, double draft_ms);

    void forgetOthers(const Document& document);

private:
    struct Entry {
        double full_ms = 0.0;
        double full_triangles = 0.0; // of the LOD that cost full_ms
        double draft_ms = 0.0;       // the last one that was taken into account
        double wanted_triangles = 0.0;
        LodSourcePtr source;
        std::uint64_t position = 0;
        std::shared_ptr<const Lod> lod;
    };

    double expectedCost(const Entry& entry, const Lane& lane) const;

    double ms_per_triangle_;
    std::map<LaneId, Entry> entries_;
};

} // namespace lodestone
