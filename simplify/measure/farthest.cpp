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
constexpr double kClose = 0.5;               // of the maximum reached: what is nearer cannot be it
constexpr std::size_t kLeafTriangles = 4;    // of a chunk, measured one by one
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

// Of the corners from a triangle that is `known` from one of them; past `enough` any number.
double farthestCorner(const std::array<Corner, 3>& corners,
                      const Triangle& to,
                      double known,
                      double enough) {
    double farthest2 = known * known;
    for (const Corner& corner : corners)
        if (farthest2 < enough * enough)
            farthest2 = std::max(farthest2, squaredDistance(corner.point, to));
    return std::sqrt(farthest2);
}

// No point of the triangle is farther. Distance changes no faster than position, and to a convex
// set it is convex: largest at a corner. Not made tighter once it is at most `enough`.
double boundOf(const std::array<Corner, 3>& corners, const ClosestSurface& to, double enough) {
    double bound = std::numeric_limits<double>::infinity();
    for (const Corner& corner : corners) {
        double reach2 = 0.0;
        for (const Corner& other : corners) {
            const glm::dvec3 apart = other.point - corner.point;
            reach2 = std::max(reach2, glm::dot(apart, apart));
        }
        bound = std::min(bound, corner.hit.distance + std::sqrt(reach2));
    }
    for (const Corner& corner : corners) {
        if (bound <= enough)
            break;
        const Triangle closest = to.triangle(corner.hit);
        bound = std::min(bound, farthestCorner(corners, closest, corner.hit.distance, bound));
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
    double bound = boundOf(corners, to, threshold(found.reached));
    if (bound <= threshold(found.reached))
        return;
    const glm::dvec3 middle = (corners[0].point + corners[1].point + corners[2].point) / 3.0;
    cursor.startAt(corners[0].hit);
    const ClosestSurface::Hit hit = cursor.closest(middle);
    reached = std::max(reached, hit.distance);
    found.reached = std::max(found.reached, reached);
    bound = std::min(bound, farthestCorner(corners, to.triangle(hit), 0.0, bound));
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

// Looks for the farthest point of a chunk.
class ChunkSearch {
public:
    ChunkSearch(const SurfacePiece& piece,
                const Chunk& chunk,
                const ClosestSurface& to,
                Found& found)
        : to_(to), cursor_(to), found_(found) {
        const auto first = piece.geometry->indices.begin();
        const auto begin = first + 3 * std::ptrdiff_t{chunk.begin};
        const auto end = first + 3 * std::ptrdiff_t{chunk.end};
        std::vector<std::uint32_t> vertices(begin, end); // each once, rising
        std::ranges::sort(vertices);
        vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
        for (const std::uint32_t vertex : vertices)
            corners_.push_back({{piece.corner(vertex), {}}, false});
        for (auto triangle = begin; triangle != end; triangle += 3) {
            std::array<std::uint32_t, 3> corners{};
            for (std::size_t c = 0; c < 3; ++c)
                corners[c] = static_cast<std::uint32_t>(
                    std::ranges::lower_bound(vertices, triangle[static_cast<std::ptrdiff_t>(c)]) -
                    vertices.begin());
            // What reaches too far is not part of the surface.
            if (std::ranges::none_of(
                    corners, [&](std::uint32_t at) { return isFar(corners_[at].corner.point); }))
                triangles_.push_back(corners);
        }
    }

    void run() { search(0, triangles_.size()); }

private:
    struct Lazy {
        Corner corner;
        bool measured = false;
    };

    // Neighbours in the file lie together more often than not: halves of halves are smaller.
    void search(std::size_t begin, std::size_t end) {
        if (!mayReach(begin, end, threshold(found_.reached)))
            return;
        if (end - begin > kLeafTriangles) {
            const std::size_t middle = begin + (end - begin) / 2;
            search(begin, middle);
            search(middle, end);
            return;
        }
        for (std::size_t t = begin; t < end; ++t)
            consider({measured(triangles_[t][0]),
                      measured(triangles_[t][1]),
                      measured(triangles_[t][2])},
                     to_,
                     cursor_,
                     found_);
    }

    // False if all of it is closer than the limit, which one query tells where it is small.
    bool mayReach(std::size_t begin, std::size_t end, double limit) {
        if (begin == end)
            return false;
        glm::dvec3 low(std::numeric_limits<double>::max());
        glm::dvec3 high(std::numeric_limits<double>::lowest());
        for (std::size_t t = begin; t < end; ++t)
            for (const std::uint32_t at : triangles_[t]) {
                low = glm::min(low, corners_[at].corner.point);
                high = glm::max(high, corners_[at].corner.point);
            }
        const double radius = 0.5 * glm::length(high - low);
        return radius >= limit || cursor_.closest(0.5 * (low + high)).distance + radius > limit;
    }

    const Corner& measured(std::uint32_t at) {
        Lazy& lazy = corners_[at];
        if (!lazy.measured)
            lazy.corner.hit = cursor_.closest(lazy.corner.point, kClose * found_.reached);
        lazy.measured = true;
        return lazy.corner;
    }

    const ClosestSurface& to_;
    ClosestSurface::Cursor cursor_;
    Found& found_;
    std::vector<Lazy> corners_;                           // the chunk's vertices, each once
    std::vector<std::array<std::uint32_t, 3>> triangles_; // indices into corners_
};

// Into four alike.
void split(const Open& open, const ClosestSurface& to, Found& found) {
    ClosestSurface::Cursor cursor(to);
    const auto& [a, b, c] = open.corners;
    const auto between = [&](const Corner& from, const Corner& until) {
        const glm::dvec3 point = 0.5 * (from.point + until.point);
        cursor.startAt(from.hit);
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
                ChunkSearch(pieces[chunk.piece], chunk, to_, found).run();
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
