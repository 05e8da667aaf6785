#pragma once
// The distance from points to an instanced surface (Embree point queries; instances stay
// instances).
#include "simplify/measure/surface.h"

#include <memory>

namespace lodestone {

struct SurfaceTree;

// Immutable once built; queries from any number of threads at once.
class ClosestSurface {
public:
    // pieces: any transforms, sheared, mirrored and singular ones too; their geometries must
    // outlive the result. Memory: 12 bytes per distinct vertex plus the hierarchy; pieces drawn
    // once, and those whose transform cannot be inverted well, are transformed and stored on their
    // own. Errors: BadInput if no triangle is near the frame; Cancelled; Failed (Embree, out of
    // memory). O(distinct triangles * log + pieces), parallel.
    static Result<ClosestSurface> build(std::span<const SurfacePiece> pieces,
                                        const JobContext& job);

    ClosestSurface(ClosestSurface&&) noexcept;
    ClosestSurface& operator=(ClosestSurface&&) noexcept;
    ~ClosestSurface();

    // A triangle of the surface, nearest to some point.
    struct Hit {
        double distance = 0.0;      // of that point, in the frame
        std::uint32_t piece = 0;    // of those given to build
        std::uint32_t part = 0;     // inside this class
        std::uint32_t triangle = 0; // of the part
    };

    Triangle triangle(const Hit& hit) const; // in the frame, as it is measured to
    // Of the piece's geometry.
    std::size_t geometryTriangle(const Hit& hit) const;

    // One thread's chain of queries. The triangle found last bounds the next search, so points in
    // spatial order are fast; the answers do not depend on the order.
    class Cursor {
    public:
        explicit Cursor(const ClosestSurface& surface) : surface_(&surface) {}

        // hit: of this surface, thought to be near the next point.
        void startAt(const Hit& hit) {
            last_part_ = hit.part;
            last_triangle_ = hit.triangle;
        }

        // point and result in the frame of the pieces; not farther out than kFarLimit.
        // Exact to double for instances, to float of the frame for pieces stored on their own.
        Hit closest(const glm::dvec3& point) { return closest(point, 0.0); }

        // As closest, but any triangle will do that is not farther than `enough`: much faster where
        // there are many. Which one depends on the queries before.
        Hit closest(const glm::dvec3& point, double enough);

    private:
        const ClosestSurface* surface_;
        std::uint32_t last_part_ = kNone;
        std::uint32_t last_triangle_ = 0;
    };

private:
    struct Search;
    explicit ClosestSurface(std::unique_ptr<SurfaceTree> tree);
    std::unique_ptr<SurfaceTree> tree_;
};

} // namespace lodestone
