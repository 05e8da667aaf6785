#include "simplify/measure/closest_surface.h"

#include "simplify/measure/surface_tree.h"

#include <algorithm>
#include <cmath>

namespace lodestone {

namespace {

// Culling is done in float. What it may err by, relative to the coordinates (about 30 float ulps).
constexpr double kCullMargin = 4e-6;

// How far culling in float may err at a point, in the point's space.
double cullMargin(const glm::dvec3& point, double extent) {
    return kCullMargin *
           (extent + std::max({std::abs(point.x), std::abs(point.y), std::abs(point.z)}));
}

RTCPointQuery makeQuery(const glm::dvec3& point, double radius) {
    RTCPointQuery query;
    query.x = static_cast<float>(point.x);
    query.y = static_cast<float>(point.y);
    query.z = static_cast<float>(point.z);
    query.time = 0.0f;
    query.radius = static_cast<float>(radius);
    return query;
}

} // namespace

Result<ClosestSurface> ClosestSurface::build(std::span<const SurfacePiece> pieces,
                                             const JobContext& job) {
    Result<std::unique_ptr<SurfaceTree>> tree = SurfaceTree::build(pieces, job);
    if (!tree)
        return tl::unexpected(tree.error());
    return ClosestSurface(std::move(*tree));
}

ClosestSurface::ClosestSurface(std::unique_ptr<SurfaceTree> tree) : tree_(std::move(tree)) {}

ClosestSurface::ClosestSurface(ClosestSurface&&) noexcept = default;
ClosestSurface& ClosestSurface::operator=(ClosestSurface&&) noexcept = default;
ClosestSurface::~ClosestSurface() = default;

struct ClosestSurface::Search {
    const SurfaceTree* tree = nullptr;
    glm::dvec3 point{0.0};
    double margin = 0.0;  // of culling in the frame
    double enough2 = 0.0; // what need not be improved
    double best2 = std::numeric_limits<double>::infinity();
    std::uint32_t best_part = kNone;
    std::uint32_t best_triangle = 0;

    bool done() const { return best2 <= enough2; }

    // What has to be searched around the point so that nothing closer is missed.
    double radius() const { return done() ? 0.0 : std::sqrt(best2) * (1.0 + kCullMargin) + margin; }

    // True if the triangle is the closest so far.
    bool offer(std::uint32_t part, std::uint32_t index) {
        const double distance2 = squaredDistance(point, tree->triangle(part, index));
        if (!(distance2 < best2))
            return false;
        best2 = distance2;
        best_part = part;
        best_triangle = index;
        return true;
    }

    // A search that goes on in the mesh of a placement.
    struct InMesh {
        Search* search = nullptr;
        std::uint32_t part = 0;
        double mesh_per_frame = 1.0;
        double margin = 0.0;

        double radius() const {
            return search->done() ? 0.0 : search->radius() * mesh_per_frame + margin;
        }

        static bool visit(RTCPointQueryFunctionArguments* found) {
            auto& in_mesh = *static_cast<InMesh*>(found->userPtr);
            if (!in_mesh.search->offer(in_mesh.part, found->primID))
                return false;
            found->query->radius =
                std::min(found->query->radius, static_cast<float>(in_mesh.radius()));
            return true;
        }
    };

    bool searchPlacement(std::uint32_t index) {
        const SurfaceTree::Placement& placement = tree->placements[index];
        const double before2 = best2;
        const double reach = radius();
        if (placement.box.squaredDistance(point) > reach * reach)
            return false;
        const SurfaceTree::Box& mesh_box = placement.shared->box;
        const glm::dvec3 in_mesh_point = placement.to_mesh * glm::dvec4(point, 1.0);
        InMesh in_mesh{this,
                       static_cast<std::uint32_t>(tree->stored.size()) + index,
                       placement.mesh_per_frame,
                       cullMargin(in_mesh_point, glm::length(mesh_box.max - mesh_box.min))};
        RTCPointQuery query = makeQuery(in_mesh_point, in_mesh.radius());
        RTCPointQueryContext context;
        rtcInitPointQueryContext(&context);
        rtcPointQuery(placement.shared->scene.get(), &query, &context, InMesh::visit, &in_mesh);
        return best2 < before2;
    }

    static bool visit(RTCPointQueryFunctionArguments* found) {
        auto& search = *static_cast<Search*>(found->userPtr);
        const bool closer = found->geomID < search.tree->stored.size()
                                ? search.offer(found->geomID, found->primID)
                                : search.searchPlacement(found->primID);
        if (closer)
            found->query->radius =
                std::min(found->query->radius, static_cast<float>(search.radius()));
        return closer;
    }
};

Triangle ClosestSurface::triangle(const Hit& hit) const {
    return tree_->triangle(hit.part, hit.triangle);
}

std::size_t ClosestSurface::geometryTriangle(const Hit& hit) const {
    if (hit.part >= tree_->stored.size() || tree_->stored[hit.part].kept.empty())
        return hit.triangle;
    return tree_->stored[hit.part].kept[hit.triangle];
}

ClosestSurface::Hit ClosestSurface::Cursor::closest(const glm::dvec3& point, double enough) {
    Search search;
    search.tree = surface_->tree_.get();
    search.point = point;
    search.margin = cullMargin(point, 1.0);
    search.enough2 = enough * enough;
    if (last_part_ != kNone)
        search.offer(last_part_, last_triangle_);
    if (!search.done()) {
        RTCPointQuery query = makeQuery(point, search.radius());
        RTCPointQueryContext context;
        rtcInitPointQueryContext(&context);
        rtcPointQuery(search.tree->top.get(), &query, &context, Search::visit, &search);
    }
    last_part_ = search.best_part;
    last_triangle_ = search.best_triangle;
    const auto& stored = search.tree->stored;
    const std::uint32_t part = search.best_part;
    const std::uint32_t piece = part < stored.size()
                                    ? stored[part].piece
                                    : search.tree->placements[part - stored.size()].piece;
    return {std::sqrt(search.best2), piece, part, search.best_triangle};
}

} // namespace lodestone
