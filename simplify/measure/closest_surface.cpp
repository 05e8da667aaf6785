#include "simplify/measure/closest_surface.h"

#include <algorithm>
#include <cmath>
#include <embree3/rtcore.h>
#include <limits>
#include <unordered_map>

namespace lodestone {

namespace {

struct Release {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }

    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }

    void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};

using DeviceHandle = std::unique_ptr<RTCDeviceTy, Release>;
using SceneHandle = std::unique_ptr<RTCSceneTy, Release>;
using GeometryHandle = std::unique_ptr<RTCGeometryTy, Release>;

// Above this ratio of an instance's longest to its shortest axis, the sphere of a query covers too
// much of the instance's own space, and a flat one has no inverse: it is stored in the frame.
constexpr double kMaxStretch = 50.0;
// Culling is done in float. What it may err by, relative to the coordinates (about 30 float ulps).
constexpr double kCullMargin = 4e-6;

struct Box {
    glm::dvec3 min{std::numeric_limits<double>::max()};
    glm::dvec3 max{std::numeric_limits<double>::lowest()};

    void add(const glm::dvec3& point) {
        min = glm::min(min, point);
        max = glm::max(max, point);
    }

    glm::dvec3 center() const { return 0.5 * (min + max); }

    double squaredDistance(const glm::dvec3& point) const {
        const glm::dvec3 outside = glm::max(glm::max(min - point, point - max), glm::dvec3(0.0));
        return glm::dot(outside, outside);
    }
};

// Vertices and indices as Embree holds them.
struct Mesh {
    const glm::vec3* positions = nullptr;
    const std::uint32_t* indices = nullptr;

    Triangle triangle(std::uint32_t index) const {
        const std::uint32_t* corners = indices + 3 * static_cast<std::size_t>(index);
        return {positions[corners[0]], positions[corners[1]], positions[corners[2]]};
    }
};

// A geometry that several instances draw, stored once relative to its centre, where float is dense.
struct SharedMesh {
    SceneHandle scene;
    Mesh mesh;
    Box box; // before centring
};

// A piece in the frame.
struct StoredMesh {
    Mesh mesh;
    std::uint32_t piece = 0;
    std::vector<std::uint32_t> kept; // triangles of the piece's geometry; empty: all of them
};

// One drawing of a shared mesh.
struct Placement {
    const SharedMesh* shared = nullptr;
    std::uint32_t piece = 0;
    glm::dmat4x3 to_frame{1.0};
    glm::dmat4x3 to_mesh{1.0};
    double mesh_per_frame = 1.0; // the longest that a unit of the frame gets in the mesh
    Box box;                     // in the frame

    Triangle triangle(std::uint32_t index) const {
        Triangle result = shared->mesh.triangle(index);
        for (glm::dvec3& corner : result)
            corner = to_frame * glm::dvec4(corner, 1.0);
        return result;
    }
};

bool keepBuilding(void* job, double /*fraction*/) {
    return !static_cast<const JobContext*>(job)->stopRequested();
}

// The largest singular value. Eigenvalues of a symmetric 3x3 matrix in closed form: Smith 1961.
double longestStretch(const glm::dmat3& matrix) {
    const glm::dmat3 gram = glm::transpose(matrix) * matrix;
    const double mean = (gram[0][0] + gram[1][1] + gram[2][2]) / 3.0;
    const glm::dmat3 rest = gram - glm::dmat3(mean);
    double spread2 = 0.0;
    for (int column = 0; column < 3; ++column)
        spread2 += glm::dot(rest[column], rest[column]);
    const double spread = std::sqrt(spread2 / 6.0);
    if (spread <= 1e-12 * mean)
        return std::sqrt(mean);
    const double cosine = std::clamp(0.5 * glm::determinant(rest / spread), -1.0, 1.0);
    return std::sqrt(mean + 2.0 * spread * std::cos(std::acos(cosine) / 3.0));
}

Box boxOf(const Geometry& geometry) {
    Box box;
    for (const std::uint32_t index : geometry.indices)
        box.add(glm::dvec3(geometry.positions[index]));
    return box;
}

Box transformed(const Box& box, const glm::dmat4& transform) {
    Box result;
    for (int corner = 0; corner < 8; ++corner)
        result.add(glm::dvec3(transform * glm::dvec4((corner & 1) != 0 ? box.max.x : box.min.x,
                                                     (corner & 2) != 0 ? box.max.y : box.min.y,
                                                     (corner & 4) != 0 ? box.max.z : box.min.z,
                                                     1.0)));
    return result;
}

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

void boundPlacement(const RTCBoundsFunctionArguments* arguments) {
    const auto& placements =
        *static_cast<const std::vector<Placement>*>(arguments->geometryUserPtr);
    const Box& box = placements[arguments->primID].box;
    RTCBounds& bounds = *arguments->bounds_o;
    bounds.lower_x = static_cast<float>(box.min.x);
    bounds.lower_y = static_cast<float>(box.min.y);
    bounds.lower_z = static_cast<float>(box.min.z);
    bounds.upper_x = static_cast<float>(box.max.x);
    bounds.upper_y = static_cast<float>(box.max.y);
    bounds.upper_z = static_cast<float>(box.max.z);
}

} // namespace

// Embree's own instances are not used: its point queries through them lose closest triangles when
// instances of different scales meet. Placements are boxes of a user geometry; the query goes on in
// the placed mesh with a sphere that covers the original one.
struct ClosestSurface::Tree {
    DeviceHandle device;
    SceneHandle top; // geometries 0..stored-1: meshes in the frame; then one with all placements
    std::vector<StoredMesh> stored;
    std::unordered_map<const Geometry*, SharedMesh> shared;
    std::vector<Placement> placements;

    Result<void> check(const JobContext& job) const;
    Result<Mesh> addTriangles(RTCScene scene,
                              std::span<const glm::vec3> positions,
                              std::span<const std::uint32_t> indices,
                              const JobContext& job) const;
    Result<void> commit(RTCScene scene, const JobContext& job) const;
    Result<void> buildShared(const Geometry& geometry, SharedMesh& mesh, const JobContext& job);
    Result<void> addPiece(const SurfacePiece& piece, std::uint32_t number, const JobContext& job);
    Result<void> addStored(const SurfacePiece& piece, std::uint32_t number, const JobContext& job);
    void attachPlacements();

    // part: index into stored, or behind those into placements.
    Triangle triangle(std::uint32_t part, std::uint32_t index) const {
        return part < stored.size() ? stored[part].mesh.triangle(index)
                                    : placements[part - stored.size()].triangle(index);
    }
};

// Turns Embree's own error into ours.
Result<void> ClosestSurface::Tree::check(const JobContext& job) const {
    const RTCError error = rtcGetDeviceError(device.get());
    if (job.stopRequested() || error == RTC_ERROR_CANCELLED)
        return cancelled();
    if (error == RTC_ERROR_OUT_OF_MEMORY)
        return fail(ErrorKind::Failed, "distance: out of memory; measure a smaller scene");
    if (error != RTC_ERROR_NONE)
        return fail(ErrorKind::Failed,
                    "distance: Embree reports error " + std::to_string(static_cast<int>(error)));
    return {};
}

Result<Mesh> ClosestSurface::Tree::addTriangles(RTCScene scene,
                                                std::span<const glm::vec3> positions,
                                                std::span<const std::uint32_t> indices,
                                                const JobContext& job) const {
    const GeometryHandle geometry(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
    void* const vertex_buffer = rtcSetNewGeometryBuffer(geometry.get(),
                                                        RTC_BUFFER_TYPE_VERTEX,
                                                        0,
                                                        RTC_FORMAT_FLOAT3,
                                                        sizeof(glm::vec3),
                                                        positions.size());
    void* const index_buffer = rtcSetNewGeometryBuffer(geometry.get(),
                                                       RTC_BUFFER_TYPE_INDEX,
                                                       0,
                                                       RTC_FORMAT_UINT3,
                                                       3 * sizeof(std::uint32_t),
                                                       indices.size() / 3);
    if (const Result<void> ok = check(job); !ok)
        return tl::unexpected(ok.error());
    std::ranges::copy(positions, static_cast<glm::vec3*>(vertex_buffer));
    std::ranges::copy(indices, static_cast<std::uint32_t*>(index_buffer));
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometry(scene, geometry.get());
    return Mesh{static_cast<const glm::vec3*>(vertex_buffer),
                static_cast<const std::uint32_t*>(index_buffer)};
}

Result<void> ClosestSurface::Tree::commit(RTCScene scene, const JobContext& job) const {
    rtcSetSceneProgressMonitorFunction(scene, keepBuilding, const_cast<JobContext*>(&job));
    rtcCommitScene(scene);
    rtcSetSceneProgressMonitorFunction(scene, nullptr, nullptr);
    return check(job);
}

Result<void> ClosestSurface::Tree::buildShared(const Geometry& geometry,
                                               SharedMesh& mesh,
                                               const JobContext& job) {
    mesh.box = boxOf(geometry);
    std::vector<glm::vec3> positions(geometry.positions.size());
    std::ranges::transform(geometry.positions, positions.begin(), [&](const glm::vec3& position) {
        return glm::vec3(glm::dvec3(position) - mesh.box.center());
    });
    mesh.scene.reset(rtcNewScene(device.get()));
    const Result<Mesh> triangles = addTriangles(mesh.scene.get(), positions, geometry.indices, job);
    if (!triangles)
        return tl::unexpected(triangles.error());
    mesh.mesh = *triangles;
    return commit(mesh.scene.get(), job);
}

// Places a shared geometry, or stores the piece on its own.
Result<void> ClosestSurface::Tree::addPiece(const SurfacePiece& piece,
                                            std::uint32_t number,
                                            const JobContext& job) {
    const auto found = shared.find(piece.geometry);
    if (found == shared.end())
        return addStored(piece, number, job);
    const SharedMesh& mesh = found->second;
    Placement placement;
    placement.shared = &mesh;
    placement.piece = number;
    placement.box = transformed(mesh.box, piece.to_frame);
    const glm::dmat3 linear(piece.to_frame);
    const glm::dmat3 inverse = glm::inverse(linear);
    placement.mesh_per_frame = longestStretch(inverse);
    const double stretch = longestStretch(linear) * placement.mesh_per_frame;
    const double mesh_extent = glm::length(mesh.box.max - mesh.box.min) * placement.mesh_per_frame;
    // Negated so that what is not a number is stored, too.
    if (!(stretch <= kMaxStretch && mesh_extent <= std::numeric_limits<float>::max()) ||
        isFar(placement.box.min) || isFar(placement.box.max))
        return addStored(piece, number, job);
    placement.to_frame = glm::dmat4x3(piece.to_frame);
    placement.to_frame[3] += linear * mesh.box.center();
    placement.to_mesh =
        glm::dmat4x3(inverse[0], inverse[1], inverse[2], -(inverse * placement.to_frame[3]));
    placements.push_back(placement);
    return {};
}

// Transforms a piece into the frame and leaves out what reaches too far.
Result<void> ClosestSurface::Tree::addStored(const SurfacePiece& piece,
                                             std::uint32_t number,
                                             const JobContext& job) {
    const Geometry& geometry = *piece.geometry;
    std::vector<glm::vec3> positions(geometry.positions.size());
    std::vector<bool> far(positions.size());
    for (std::uint32_t v = 0; v < positions.size(); ++v) {
        const glm::dvec3 position = piece.corner(v);
        far[v] = isFar(position);
        positions[v] = far[v] ? glm::vec3(0.0f) : glm::vec3(position);
    }
    std::vector<std::uint32_t> indices;
    indices.reserve(geometry.indices.size());
    std::vector<std::uint32_t> kept;
    for (std::uint32_t t = 0; t < geometry.triangleCount(); ++t) {
        const std::uint32_t* corners = geometry.indices.data() + 3 * std::size_t{t};
        if (far[corners[0]] || far[corners[1]] || far[corners[2]])
            continue;
        indices.insert(indices.end(), corners, corners + 3);
        kept.push_back(t);
    }
    if (indices.empty())
        return {};
    const Result<Mesh> mesh = addTriangles(top.get(), positions, indices, job);
    if (!mesh)
        return tl::unexpected(mesh.error());
    if (kept.size() == geometry.triangleCount())
        kept.clear();
    stored.push_back({*mesh, number, std::move(kept)});
    return {};
}

void ClosestSurface::Tree::attachPlacements() {
    if (placements.empty())
        return;
    const GeometryHandle boxes(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_USER));
    rtcSetGeometryUserPrimitiveCount(boxes.get(), static_cast<unsigned>(placements.size()));
    rtcSetGeometryUserData(boxes.get(), &placements);
    rtcSetGeometryBoundsFunction(boxes.get(), boundPlacement, nullptr);
    rtcCommitGeometry(boxes.get());
    rtcAttachGeometry(top.get(), boxes.get());
}

Result<ClosestSurface> ClosestSurface::build(std::span<const SurfacePiece> pieces,
                                             const JobContext& job) {
    auto tree = std::make_unique<Tree>();
    tree->device.reset(rtcNewDevice(nullptr));
    if (!tree->device)
        return fail(ErrorKind::Failed, "distance: Embree could not be started");
    tree->top.reset(rtcNewScene(tree->device.get()));
    std::unordered_map<const Geometry*, std::size_t> uses;
    for (const SurfacePiece& piece : pieces)
        if (++uses[piece.geometry] == 2)
            tree->shared.try_emplace(piece.geometry);
    for (auto& [geometry, mesh] : tree->shared)
        if (const Result<void> ok = tree->buildShared(*geometry, mesh, job); !ok)
            return tl::unexpected(ok.error());
    for (std::uint32_t number = 0; number < pieces.size(); ++number) {
        if (job.stopRequested())
            return cancelled();
        if (const Result<void> ok = tree->addPiece(pieces[number], number, job); !ok)
            return tl::unexpected(ok.error());
    }
    if (tree->stored.empty() && tree->placements.empty())
        return badInput("distance: no triangle to measure to; choose a scene with triangles");
    tree->attachPlacements();
    if (const Result<void> ok = tree->commit(tree->top.get(), job); !ok)
        return tl::unexpected(ok.error());
    return ClosestSurface(std::move(tree));
}

ClosestSurface::ClosestSurface(std::unique_ptr<Tree> tree) : tree_(std::move(tree)) {}

ClosestSurface::ClosestSurface(ClosestSurface&&) noexcept = default;
ClosestSurface& ClosestSurface::operator=(ClosestSurface&&) noexcept = default;
ClosestSurface::~ClosestSurface() = default;

struct ClosestSurface::Search {
    const Tree* tree = nullptr;
    glm::dvec3 point{0.0};
    double margin = 0.0; // of culling in the frame
    double best2 = std::numeric_limits<double>::infinity();
    std::uint32_t best_part = kNone;
    std::uint32_t best_triangle = 0;

    // What has to be searched around the point so that nothing closer is missed.
    double radius() const { return std::sqrt(best2) * (1.0 + kCullMargin) + margin; }

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

        double radius() const { return search->radius() * mesh_per_frame + margin; }

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
        const Placement& placement = tree->placements[index];
        const double before2 = best2;
        const double reach = radius();
        if (placement.box.squaredDistance(point) > reach * reach)
            return false;
        const Box& mesh_box = placement.shared->box;
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

ClosestSurface::Hit ClosestSurface::Cursor::closest(const glm::dvec3& point) {
    Search search;
    search.tree = surface_->tree_.get();
    search.point = point;
    search.margin = cullMargin(point, 1.0);
    if (last_part_ != kNone)
        search.offer(last_part_, last_triangle_);
    RTCPointQuery query = makeQuery(point, search.radius());
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(search.tree->top.get(), &query, &context, Search::visit, &search);
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
