#include "app/drafts.h"

#include "app/lod_position.h"

#include <algorithm>

namespace lodestone {

namespace {

constexpr double kDraftMs = 12.0; // what a draft may cost: three lanes in 36 ms
constexpr double kFewestTriangles = 500.0;

// An edge-collapse source for the scene that the lane shows: its own, else another lane's.
LodSourcePtr sourceFor(const Document& document, const Lane& lane) {
    const auto suits = [&](const Lane& other) {
        return other.settings.algorithm && other.status.source &&
               other.settings.algorithm->family == Family::EdgeCollapse &&
               other.status.source->scene() == lane.status.scene;
    };
    if (suits(lane))
        return lane.status.source;
    const auto other = std::ranges::find_if(document.lanes, suits);
    return other == document.lanes.end() ? nullptr : other->status.source;
}

} // namespace

double Drafts::expectedCost(const Entry& entry, const Lane& lane) const {
    const auto triangles = static_cast<double>(lane.status.lod->triangles);
    if (entry.full_ms > 0.0 && entry.full_triangles > 0.0)
        return entry.full_ms * triangles / entry.full_triangles;
    return triangles * ms_per_triangle_;
}

std::shared_ptr<const Lod> Drafts::draftOf(const Document& document, const Lane& lane) {
    if (!lane.status.lod)
        return nullptr;
    Entry& entry = entries_[lane.id];
    const double cost_ms = expectedCost(entry, lane);
    if (cost_ms <= kPicturesMs)
        return nullptr;
    LodSourcePtr source = sourceFor(document, lane);
    if (!source)
        return nullptr;
    const auto full = static_cast<double>(lane.status.lod->triangles);
    if (entry.wanted_triangles <= 0.0)
        entry.wanted_triangles = std::max(kFewestTriangles, full * kDraftMs / cost_ms);
    const std::uint64_t position = finestWithin(*source, std::min(full, entry.wanted_triangles));
    if (entry.source != source || entry.position != position || !entry.lod) {
        const Lod* const previous = entry.source == source ? entry.lod.get() : nullptr;
        entry.lod = std::make_shared<const Lod>(source->readOut(position, previous));
        entry.source = std::move(source);
        entry.position = position;
    }
    return entry.lod;
}

void Drafts::setCosts(const Lane& lane, double full_ms, double draft_ms) {
    Entry& entry = entries_[lane.id];
    if (full_ms > 0.0 && full_ms != entry.full_ms && lane.status.lod) {
        entry.full_ms = full_ms;
        entry.full_triangles = static_cast<double>(lane.status.lod->triangles);
    }
    if (draft_ms <= 0.0 || draft_ms == entry.draft_ms)
        return;
    entry.draft_ms = draft_ms;
    // In large steps and with a dead zone, so that drafts do not flicker between sizes.
    if (draft_ms > 2.0 * kDraftMs)
        entry.wanted_triangles = std::max(kFewestTriangles, entry.wanted_triangles * 0.5);
    else if (draft_ms < 0.25 * kDraftMs)
        entry.wanted_triangles *= 2.0;
}

void Drafts::forgetOthers(const Document& document) {
    std::erase_if(entries_, [&](const auto& entry) { return !document.findLane(entry.first); });
}

} // namespace lodestone
