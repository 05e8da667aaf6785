#include "simplify/measure/farthest.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tbb/parallel_for.h>

namespace lodestone {

namespace {

constexpr double kTolerance = 0.002;         // of the maximum
constexpr double kSmallest = 2e-6;           // of the frame: what is nearer is on the surface
constexpr std::size_t kChunkTriangles = 256; // of one piece, looked at together
constexpr std::size_t kBatchChunks = 2048;   // what is held at a time
constexpr double kHope = 0.05;              // share of a bound's excess that is expected to be real
constexpr std::size_t kMostOpen = 1u << 16; // triangles kept for splitting
constexpr std::size_t kRoundTriangles = 1024; // split at a time, the most promising ones
constexpr std::size_t kMostSplits = std::size_t{16} * 1024; // in all

double threshold(double reached) {
    return reached * (1.0 + kTolerance) + kSmallest;
}

struct Corner {
    glm::dvec3 point{0.0};
    ClosestSurface::Hit hit;
};

// A triangle that may hold the maximum.
struct Open {
    std::array<Corner, 3> corners;
    double bound = 0.0;
    double hope = 0.0; // a guess at its maximum: what is split first
};

// What was found on part of the surface.
struct Found {
    double reached = 0.0;
    std::vector<Open> open;
};

double farthestCorner(const std::array<Corner, 3>& corners, const Triangle& to) {
    double farthest2 = 0.0;
    for (const Corner& corner : corners)
        farthest2 = std::max(farthest2, squaredDistance(corner.point, to));
    return std::sqrt(farthest2);
}

// No point of the triangle is farther. Distance changes no faster than position, and to a convex
// set it is convex: largest at a corner.
double boundOf(const std::array<Corner, 3>& corners, const ClosestSurface& to) {
    double bound = std::numeric_limits<double>::infinity();
    for (const Corner& corner : corners) {
        double reach = 0.0;
        for (const Corner& other : corners)
            reach = std::max(reach, glm::length(other.point - corner.point));
        bound = std::min(bound, corner.hit.distance + reach);
        bound = std::min(bound, farthestCorner(corners, to.triangle(corner.hit)));
    }
    return bound;
}

// Measures the middle and keeps the triangle if it may still hold the maximum.
void consider(const std::array<Corner, 3>& corners,
              const ClosestSurface& to,
              ClosestSurface::Cursor& cursor,
              Found& found) {
    double reached = 0.0; // on this triangle
    for (const Corner& corner : corners)
        reached = std::max(reached, corner.hit.distance);
    found.reached = std::max(found.reached, reached);
    double bound = boundOf(corners, to);
    if (bound <= threshold(found.reached))
        return;
    const glm::dvec3 middle = (corners[0].point + corners[1].point + corners[2].point) / 3.0;
    const ClosestSurface::Hit hit = cursor.closest(middle);
    reached = std::max(reached, hit.distance);
    found.reached = std::max(found.reached, reached);
    bound = std::min(bound, farthestCorner(corners, to.triangle(hit)));
    if (bound > threshold(found.reached))
        found.open.push_back({corners, bound, reached + kHope * (bound - reached)});
}

// Consecutive triangles of a piece.
struct Chunk {
    std::uint32_t piece = 0;
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
};

std::vector<Chunk> chunksOf(std::span<const SurfacePiece> pieces) {
    std::vector<Chunk> chunks;
    for (std::uint32_t p = 0; p < pieces.size(); ++p) {
        const std::size_t count = pieces[p].geometry->triangleCount();
        for (std::size_t begin = 0; begin < count; begin += kChunkTriangles)
            chunks.push_back(
                {p,
                 static_cast<std::uint32_t>(begin),
                 static_cast<std::uint32_t>(std::min(begin + kChunkTriangles, count))});
    }
    return chunks;
}

// The chunk's vertices, each once, with what is closest to them.
class ChunkCorners {
public:
    ChunkCorners(const SurfacePiece& piece, const Chunk& chunk) : piece_(piece) {
        const auto& indices = piece.geometry->indices;
        vertices_.assign(indices.begin() + 3 * std::ptrdiff_t{chunk.begin},
                         indices.begin() + 3 * std::ptrdiff_t{chunk.end});
        std::ranges::sort(vertices_);
        vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
        for (const std::uint32_t vertex : vertices_) {
            corners_.push_back({piece.corner(vertex), {}});
            near_.push_back(!isFar(corners_.back().point));
        }
    }

    // False if all of it is closer than the limit, which one query often tells.
    bool mayReach(double limit, ClosestSurface::Cursor& cursor) const {
        glm::dvec3 low(std::numeric_limits<double>::max());
        glm::dvec3 high(std::numeric_limits<double>::lowest());
        for (std::size_t i = 0; i < corners_.size(); ++i)
            if (near_[i]) {
                low = glm::min(low, corners_[i].point);
                high = glm::max(high, corners_[i].point);
            }
        if (low.x > high.x)
            return false;
        const glm::dvec3 center = 0.5 * (low + high);
        return cursor.closest(center).distance + glm::length(high - center) > limit;
    }

    void measure(ClosestSurface::Cursor& cursor) {
        for (std::size_t i = 0; i < corners_.size(); ++i)
            if (near_[i])
                corners_[i].hit = cursor.closest(corners_[i].point);
    }

    // False if the triangle reaches too far to be part of the surface.
    bool gather(std::uint32_t triangle, std::array<Corner, 3>& corners) const {
        for (std::size_t c = 0; c < 3; ++c) {
            const std::uint32_t vertex = piece_.geometry->indices[3 * std::size_t{triangle} + c];
            const auto at = static_cast<std::size_t>(std::ranges::lower_bound(vertices_, vertex) -
                                                     vertices_.begin());
            if (!near_[at])
                return false;
            corners[c] = corners_[at];
        }
        return true;
    }

private:
    const SurfacePiece& piece_;
    std::vector<std::uint32_t> vertices_; // rising
    std::vector<Corner> corners_;         // [vertices_]
    std::vector<bool> near_;              // [vertices_]
};

void searchChunk(const SurfacePiece& piece,
                 const Chunk& chunk,
                 const ClosestSurface& to,
                 Found& found) {
    ClosestSurface::Cursor cursor(to);
    ChunkCorners chunk_corners(piece, chunk);
    if (!chunk_corners.mayReach(threshold(found.reached), cursor))
        return;
    chunk_corners.measure(cursor);
    std::array<Corner, 3> corners;
    for (std::uint32_t t = chunk.begin; t < chunk.end; ++t)
        if (chunk_corners.gather(t, corners))
            consider(corners, to, cursor, found);
}

// Into four alike.
void split(const Open& open, const ClosestSurface& to, Found& found) {
    ClosestSurface::Cursor cursor(to);
    const auto& [a, b, c] = open.corners;
    const auto between = [&](const Corner& from, const Corner& until) {
        const glm::dvec3 point = 0.5 * (from.point + until.point);
        return Corner{point, cursor.closest(point)};
    };
    const Corner ab = between(a, b);
    const Corner bc = between(b, c);
    const Corner ca = between(c, a);
    consider({a, ab, ca}, to, cursor, found);
    consider({ab, b, bc}, to, cursor, found);
    consider({ca, bc, c}, to, cursor, found);
    consider({ab, bc, ca}, to, cursor, found);
}

class Search {
public:
    Search(const ClosestSurface& to, double known, const JobContext& job)
        : to_(to), job_(job), reached_(known) {}

    Result<void> searchPieces(std::span<const SurfacePiece> pieces) {
        const std::vector<Chunk> chunks = chunksOf(pieces);
        for (std::size_t first = 0; first < chunks.size(); first += kBatchChunks) {
            const std::size_t count = std::min(kBatchChunks, chunks.size() - first);
            Result<void> done = searchAll(count, [&](std::size_t i, Found& found) {
                const Chunk& chunk = chunks[first + i];
                searchChunk(pieces[chunk.piece], chunk, to_, found);
            });
            if (!done)
                return done;
            job_.report(static_cast<double>(first + count) / static_cast<double>(chunks.size()));
        }
        return {};
    }

    // Splits what is most promising until nothing may reach much farther.
    Result<void> refine() {
        for (std::size_t splits = 0; !open_.empty() && splits < kMostSplits;) {
            const std::size_t count = std::min(kRoundTriangles, open_.size());
            takeBestFirst(count);
            const std::vector<Open> round(open_.begin(),
                                          open_.begin() + static_cast<std::ptrdiff_t>(count));
            open_.erase(open_.begin(), open_.begin() + static_cast<std::ptrdiff_t>(count));
            Result<void> done =
                searchAll(count, [&](std::size_t i, Found& found) { split(round[i], to_, found); });
            if (!done)
                return done;
            splits += count;
        }
        return {};
    }

    double reached() const { return reached_; }

private:
    // Runs search(i, found) for i < count on all cores and takes in what was found, in order.
    template <class Part>
    Result<void> searchAll(std::size_t count, const Part& search) {
        std::vector<Found> found(count);
        tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
            found[i].reached = reached_;
            if (!job_.stopRequested())
                search(i, found[i]);
        });
        if (job_.stopRequested())
            return cancelled();
        for (Found& part : found) {
            reached_ = std::max(reached_, part.reached);
            open_.insert(open_.end(), part.open.begin(), part.open.end());
        }
        std::erase_if(open_, [&](const Open& open) { return open.bound <= threshold(reached_); });
        if (open_.size() > kMostOpen) {
            takeBestFirst(kMostOpen);
            open_.resize(kMostOpen);
        }
        return {};
    }

    void takeBestFirst(std::size_t count) {
        std::nth_element(open_.begin(),
                         open_.begin() + static_cast<std::ptrdiff_t>(count) - 1,
                         open_.end(),
                         [](const Open& a, const Open& b) { return a.hope > b.hope; });
    }

    const ClosestSurface& to_;
    const JobContext& job_;
    double reached_ = 0.0;
    std::vector<Open> open_;
};

} // namespace

Result<double> farthestDistance(std::span<const SurfacePiece> from,
                                const ClosestSurface& to,
                                double known,
                                const JobContext& job) {
    Search whole(to, known, job);
    if (Result<void> searched = whole.searchPieces(from); !searched)
        return tl::unexpected<Error>(std::move(searched.error()));
    if (Result<void> refined = whole.refine(); !refined)
        return tl::unexpected<Error>(std::move(refined.error()));
    return whole.reached();
}

} // namespace lodestone
