// OpenMesh's decimater with error quadrics.
#include "bench/peers/peer.h"
#include "bench/timing.h"

#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>

namespace lodestone::bench {

namespace {

using HalfEdgeMesh = OpenMesh::TriMesh_ArrayKernelT<>;

// Triangles that would make the mesh non-manifold get vertices of their own.
HalfEdgeMesh halfEdgeMesh(const PeerMesh& mesh) {
    HalfEdgeMesh made;
    made.request_face_status();
    made.request_edge_status();
    made.request_vertex_status();
    made.request_halfedge_status();
    const auto add = [&](std::uint32_t vertex) {
        const glm::vec3& p = mesh.positions[vertex];
        return made.add_vertex(HalfEdgeMesh::Point(p.x, p.y, p.z));
    };
    for (std::uint32_t vertex = 0; vertex < mesh.positions.size(); ++vertex)
        add(vertex);
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const auto corner = [&](std::size_t c) {
            return OpenMesh::VertexHandle(static_cast<int>(mesh.indices[i + c]));
        };
        if (!made.add_face(corner(0), corner(1), corner(2)).is_valid())
            made.add_face(add(mesh.indices[i]), add(mesh.indices[i + 1]), add(mesh.indices[i + 2]));
    }
    return made;
}

double simplify(const Job& job, PeerMesh& out) {
    omerr().disable(); // "complex edge": answered above
    HalfEdgeMesh mesh = halfEdgeMesh(*job.mesh);
    const double start = cpuSeconds();
    {
        OpenMesh::Decimater::DecimaterT<HalfEdgeMesh> decimater(mesh);
        OpenMesh::Decimater::ModQuadricT<HalfEdgeMesh>::Handle quadrics;
        decimater.add(quadrics);
        decimater.module(quadrics).unset_max_err();
        decimater.initialize();
        decimater.decimate_to_faces(0, job.triangle_target);
    }
    mesh.garbage_collection();
    const double seconds = cpuSeconds() - start;
    for (const auto vertex : mesh.vertices()) {
        const HalfEdgeMesh::Point& p = mesh.point(vertex);
        out.positions.emplace_back(p[0], p[1], p[2]);
    }
    for (const auto face : mesh.faces())
        for (const auto vertex : mesh.fv_range(face))
            out.indices.push_back(static_cast<std::uint32_t>(vertex.idx()));
    return seconds;
}

} // namespace

MeshPeer openMeshPeer() {
    return oneByOne("OpenMesh " + std::to_string(OM_GET_VER) + "." + std::to_string(OM_GET_MAJ) +
                        " ModQuadric",
                    Welding::Positions,
                    simplify);
}

} // namespace lodestone::bench
