#pragma once
// Area-weighted, stratified points on an instanced surface: the same points whatever the number of
// threads, because sample k depends on the seed and k alone.
#include "simplify/measure/surface.h"

#include <functional>

namespace lodestone {

struct SurfaceSample {
    glm::dvec3 point{0.0};   // in the frame
    std::uint32_t piece = 0; // of those given to build
    std::size_t triangle = 0;
    glm::dvec3 weights{0.0}; // barycentric, of the triangle's corners
};

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

    // Calls visit(sample) for each sample of the range, in storage order. A sample that rounding
    // puts beyond the last triangle is not visited.
    void visit(const Request& request,
               const std::function<void(const SurfaceSample&)>& visit) const;

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

} // namespace lodestone
