#pragma once
// What a source knows of the positions that were asked for.
#include "simplify/pointcloud/cloud_submesh.h"

#include <deque>
#include <map>
#include <mutex>
#include <optional>

namespace lodestone {

// A position as far as its counts.
struct CloudDrafts {
    std::uint64_t position = 0;
    std::vector<CloudDraft> submeshes;
};

using CloudDraftsPtr = std::shared_ptr<const CloudDrafts>;
using LodPtr = std::shared_ptr<const Lod>;

struct CloudCounts {
    std::uint64_t triangles = 0; // instances counted
    double error_percent = 0.0;  // of the diagonal
    LodShape shape;
};

using CloudCountsPtr = std::shared_ptr<const CloudCounts>;

// The counts of all positions, and the last ones themselves. Thread-safe; null: not known (any
// more).
class CloudCache {
public:
    CloudCountsPtr counts(std::uint64_t position) const;
    CloudDraftsPtr drafts(std::uint64_t position) const;
    LodPtr lod(std::uint64_t position) const;

    void insert(const CloudDraftsPtr& drafts, const CloudCountsPtr& counts);
    void insert(const LodPtr& lod);

    // The coarsest that a submesh may become, once it is known.
    std::optional<CloudDraft> coarsest(std::size_t submesh, CloudFloor floor) const;
    void insertCoarsest(std::size_t submesh, CloudFloor floor, const CloudDraft& draft);

private:
    static constexpr std::size_t kMostDrafts = 6;
    static constexpr std::size_t kMostLods = 24;
    static constexpr std::uint64_t kMostTriangles = 4'000'000; // of LODs

    mutable std::mutex mutex_;
    std::map<std::uint64_t, CloudCountsPtr> counts_;
    std::deque<CloudDraftsPtr> drafts_; // oldest first
    std::deque<LodPtr> lods_;
    std::uint64_t lod_triangles_ = 0;
    std::map<std::pair<std::size_t, CloudFloor>, CloudDraft> coarsest_;
};

} // namespace lodestone
