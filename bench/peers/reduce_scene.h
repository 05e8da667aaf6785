#pragma once
// A mesh simplifier on a scene: every mesh by the same ratio, all instances kept.
#include "bench/peers/peer.h"
#include "scene/lod.h"

namespace lodestone::bench {

struct ReducedScene {
    Lod lod;
    double seconds = 0.0; // CPU of the peer's calls
};

// What a peer is given of a scene, made once.
class PeerInput {
public:
    // Submeshes that no instance draws, points and lines are left out.
    PeerInput(const Scene& scene, Welding welding, double ratio);

    // Vertices that stay keep their attributes; those that a peer makes get the attributes of the
    // nearest stored vertex, so that files and pictures compare. A mesh that comes back without
    // triangles vanishes with its instances.
    // Errors: those of the peer; Failed names it if a mesh has an index out of range or a position
    // that is not finite.
    Result<ReducedScene> reduce(const MeshPeer& peer) const;

private:
    struct Part {
        std::uint32_t submesh = 0;
        std::uint32_t primitive = 0;
        PeerMesh mesh;
        std::size_t triangle_target = 0;
    };

    GeometryPtr toGeometry(const Part& part, PeerMesh mesh) const;
    Lod toLod(std::vector<PeerMesh> meshes) const;

    const Scene* scene_;
    Welding welding_;
    std::vector<Part> parts_;
};

// Empty, or what is wrong with a mesh.
std::string faultOf(const PeerMesh& mesh);

// Equal positions made one vertex, triangles that lose a corner by it or have none left out.
PeerMesh weldedMesh(const Geometry& geometry);

} // namespace lodestone::bench
