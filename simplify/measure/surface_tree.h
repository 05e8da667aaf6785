#pragma once
// What ClosestSurface searches, as Embree holds it. Nobody else includes this.
#include "simplify/measure/surface.h"

#include <embree3/rtcore.h>
#include <limits>
#include <memory>
#include <unordered_map>

namespace lodestone {

// Embree's own instances are not used: its point queries through them lose closest triangles when
// instances of different scales meet. Placements are boxes of a user geometry; the query goes on in
// the placed mesh with a sphere that covers the original one.
struct SurfaceTree {
    struct Release {
        void operator()(RTCDevice held) const { rtcReleaseDevice(held); }

        void operator()(RTCScene held) const { rtcReleaseScene(held); }

        void operator()(RTCGeometry held) const { rtcReleaseGeometry(held); }
    };

    using DeviceHandle = std::unique_ptr<RTCDeviceTy, Release>;
    using SceneHandle = std::unique_ptr<RTCSceneTy, Release>;
    using GeometryHandle = std::unique_ptr<RTCGeometryTy, Release>;

    struct Box {
        glm::dvec3 min{std::numeric_limits<double>::max()};
        glm::dvec3 max{std::numeric_limits<double>::lowest()};

        void add(const glm::dvec3& point) {
            min = glm::min(min, point);
            max = glm::max(max, point);
        }

        glm::dvec3 center() const { return 0.5 * (min + max); }

        double squaredDistance(const glm::dvec3& point) const {
            const glm::dvec3 outside =
                glm::max(glm::max(min - point, point - max), glm::dvec3(0.0));
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

    // A geometry that several instances draw, stored once relative to its centre, where float is
    // dense.
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

    DeviceHandle device;
    SceneHandle top; // geometries 0..stored-1: meshes in the frame; then one with all placements
    std::vector<StoredMesh> stored;
    std::unordered_map<const Geometry*, SharedMesh> shared;
    std::vector<Placement> placements;

    // pieces, cancellation and errors as ClosestSurface::build.
    static Result<std::unique_ptr<SurfaceTree>> build(std::span<const SurfacePiece> pieces,
                                                      const JobContext& job);

    // part: index into stored, or behind those into placements.
    Triangle triangle(std::uint32_t part, std::uint32_t index) const {
        return part < stored.size() ? stored[part].mesh.triangle(index)
                                    : placements[part - stored.size()].triangle(index);
    }

private:
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
};

} // namespace lodestone
