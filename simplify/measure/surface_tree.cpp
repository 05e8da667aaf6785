#include "simplify/measure/surface_tree.h"

#include "simplify/stretch.h"

#include <algorithm>

namespace lodestone {

namespace {

using Box = SurfaceTree::Box;
using GeometryHandle = SurfaceTree::GeometryHandle;
using Placement = SurfaceTree::Placement;

// Above this ratio of an instance's longest to its shortest axis, the sphere of a query covers too
// much of the instance's own space, and a flat one has no inverse: it is stored in the frame.
constexpr double kMaxStretch = 50.0;

bool keepBuilding(void* job, double /*fraction*/) {
    return !static_cast<const JobContext*>(job)->stopRequested();
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

// Turns Embree's own error into ours.
Result<void> SurfaceTree::check(const JobContext& job) const {
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

Result<SurfaceTree::Mesh> SurfaceTree::addTriangles(RTCScene scene,
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

Result<void> SurfaceTree::commit(RTCScene scene, const JobContext& job) const {
    rtcSetSceneProgressMonitorFunction(scene, keepBuilding, const_cast<JobContext*>(&job));
    rtcCommitScene(scene);
    rtcSetSceneProgressMonitorFunction(scene, nullptr, nullptr);
    return check(job);
}

Result<void>
SurfaceTree::buildShared(const Geometry& geometry, SharedMesh& mesh, const JobContext& job) {
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
Result<void>
SurfaceTree::addPiece(const SurfacePiece& piece, std::uint32_t number, const JobContext& job) {
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
Result<void>
SurfaceTree::addStored(const SurfacePiece& piece, std::uint32_t number, const JobContext& job) {
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

void SurfaceTree::attachPlacements() {
    if (placements.empty())
        return;
    const GeometryHandle boxes(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_USER));
    rtcSetGeometryUserPrimitiveCount(boxes.get(), static_cast<unsigned>(placements.size()));
    rtcSetGeometryUserData(boxes.get(), &placements);
    rtcSetGeometryBoundsFunction(boxes.get(), boundPlacement, nullptr);
    rtcCommitGeometry(boxes.get());
    rtcAttachGeometry(top.get(), boxes.get());
}

Result<std::unique_ptr<SurfaceTree>> SurfaceTree::build(std::span<const SurfacePiece> pieces,
                                                        const JobContext& job) {
    auto tree = std::make_unique<SurfaceTree>();
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
    return tree;
}

} // namespace lodestone
