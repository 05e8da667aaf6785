#pragma once
// One submesh simplified to settings.
#include "scene/lod.h"
#include "simplify/pointcloud/cloud_method.h"
#include "simplify/shape_floor.h"

namespace lodestone {

// Made once per scene, shared by everything that simplifies it.
struct CloudSubmesh {
    const Submesh* submesh = nullptr;
    Complex complex;
    CloudSurface surface;        // of complex
    ShapeMeasure shape;          // of surface
    double stretch = 0.0;        // largest scale of an instance; 0: nothing to see
    double edge_length = 0.0;    // typical one, submesh units; 0: no area
    std::uint32_t triangles = 0; // the file's own
    std::uint32_t instances = 0;
};

// A submesh simplified as far as its counts and its error say.
struct CloudDraft {
    std::shared_ptr<const CloudSurface> surface; // null: the submesh as the file has it
    std::vector<PrimitiveShape> shape;           // [submesh.primitives]
    std::uint32_t triangles = 0;
    double error = 0.0; // estimate: the farthest that a vertex went, submesh units
};

// A submesh after simplification.
struct CloudPiece {
    std::vector<GeometryPtr> primitives; // the submesh's own where not changed
    std::uint32_t triangles = 0;
    double error = 0.0; // as in the draft
    bool changed = false;
};

CloudSubmesh makeCloudSubmesh(const Submesh& submesh,
                              std::span<const Instance> instances,
                              const JobContext& job);

// What a submesh must not lose.
enum class CloudFloor : std::uint8_t {
    Triangles, // keeps 4, or all it has
    Shape,     // and of several instances two fifths of every extent but a thin one
};

// Whether a draft keeps to the floor. O(faces of the draft).
bool keepsFloor(const CloudSubmesh& from, const CloudDraft& draft, CloudFloor floor);

// As the file has it.
CloudDraft originalDraft(const CloudSubmesh& from);

// settings.main: distances in the submesh's units. O(faces) nearly. Stops early where asked to.
CloudDraft draftPiece(const CloudSubmesh& from,
                      const CloudMethod& method,
                      const CloudSettings& settings,
                      const JobContext& job);

// A draft's edges flipped to Delaunay, as geometry: its counts and its error stay. As draftPiece.
CloudPiece finishPiece(const CloudSubmesh& from, const CloudDraft& draft, const JobContext& job);

// Both.
CloudPiece simplifyPiece(const CloudSubmesh& from,
                         const CloudMethod& method,
                         const CloudSettings& settings,
                         const JobContext& job);

} // namespace lodestone
