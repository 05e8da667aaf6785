#pragma once
// CGAL's mesh from ours and back. Heavy: only for the files of the CGAL peers.
#include "bench/peers/peer.h"
#include "bench/timing.h"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <CGAL/version.h>

namespace lodestone::bench {

using CgalKernel = CGAL::Simple_cartesian<double>;
using CgalMesh = CGAL::Surface_mesh<CgalKernel::Point_3>;

// Stops at a number of faces.
struct StopAtFaces {
    std::size_t faces = 0;

    template <class Cost, class Profile>
    bool operator()(const Cost& /*cost*/, const Profile& edge, std::size_t, std::size_t) const {
        return edge.surface_mesh().number_of_faces() <= faces;
    }
};

// Triangles that would make the mesh non-manifold get vertices of their own.
inline CgalMesh cgalMesh(const PeerMesh& mesh) {
    CgalMesh made;
    const auto add = [&](std::uint32_t vertex) {
        const glm::vec3& p = mesh.positions[vertex];
        return made.add_vertex(CgalKernel::Point_3(p.x, p.y, p.z));
    };
    for (std::uint32_t vertex = 0; vertex < mesh.positions.size(); ++vertex)
        add(vertex);
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const auto corner = [&](std::size_t c) {
            return CgalMesh::Vertex_index(mesh.indices[i + c]);
        };
        if (made.add_face(corner(0), corner(1), corner(2)) == CgalMesh::null_face())
            made.add_face(add(mesh.indices[i]), add(mesh.indices[i + 1]), add(mesh.indices[i + 2]));
    }
    return made;
}

inline PeerMesh fromCgal(CgalMesh& mesh) {
    mesh.collect_garbage();
    PeerMesh made;
    for (const CgalMesh::Vertex_index vertex : mesh.vertices()) {
        const CgalKernel::Point_3& p = mesh.point(vertex);
        made.positions.emplace_back(p.x(), p.y(), p.z());
    }
    for (const CgalMesh::Face_index face : mesh.faces())
        for (const CgalMesh::Vertex_index vertex : vertices_around_face(mesh.halfedge(face), mesh))
            made.indices.push_back(vertex);
    return made;
}

// collapse(mesh, stop) is timed.
template <class Collapse>
double simplifyWithCgal(const Job& job, PeerMesh& out, const Collapse& collapse) {
    CgalMesh mesh = cgalMesh(*job.mesh);
    const double start = cpuSeconds();
    collapse(mesh, StopAtFaces{job.triangle_target});
    const double seconds = cpuSeconds() - start;
    out = fromCgal(mesh);
    return seconds;
}

} // namespace lodestone::bench
