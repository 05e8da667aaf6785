#pragma once
// Area-weighted, stratified points on an instanced surface: the same points whatever the number of
// threads, because sample k depends on the seed and k alone.
#include "simplify/measure/surface.h"

#include <functional>

namespace lodestone {

class SurfaceSampler {
public:
    // pieces must outlive the sampler. O(instanced triangles), parallel; memory 24 bytes per piece
    // and per 1,024 triangles of it. Errors: Cancelled; BadInput if the area is zero.
    static Result<SurfaceSampler> build(std::span<const SurfacePiece> pieces,
                                        const JobContext& job);

    struct Request {
        std::uint64_t begin = 0; // samples [begin, end) of `count`
        std::uint64_t end = 0;
        std::uint64_t count = 1;
        std::uint64_t seed = 1;
    };

    // Calls visit(point in the frame) for each sample of the range, in storage order. A sample that
    // rounding puts beyond the last triangle is not visited.
    void visit(const Request& request, const std::function<void(const glm::dvec3&)>& visit) const;

    double area() const { return area_before_.back(); }

private:
    // Up to 1,024 consecutive triangles of a piece.
    struct Patch {
        std::uint32_t piece = 0;
        std::size_t first_triangle = 0;
        std::size_t last_triangle = 0; // one past
    };

    std::span<const SurfacePiece> pieces_;
    std::vector<Patch> patches_;
    std::vector<double> area_before_; // [patches + 1] running sum
};

// The vertices that triangles use, of all pieces, numbered in order.
class SurfaceVertices {
public:
    // pieces must outlive it. O(distinct indices + pieces).
    explicit SurfaceVertices(std::span<const SurfacePiece> pieces);

    std::uint64_t size() const { return first_.back(); }

    glm::dvec3 at(std::uint64_t index) const; // in the frame; O(log pieces)

private:
    std::span<const SurfacePiece> pieces_;
    std::vector<std::shared_ptr<const std::vector<std::uint32_t>>> used_; // [pieces]
    std::vector<std::uint64_t> first_;                                    // [pieces + 1]
};

} // namespace lodestone
