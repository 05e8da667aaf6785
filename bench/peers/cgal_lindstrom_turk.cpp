// CGAL's default edge collapse (Lindstrom and Turk 1998).
#include "bench/peers/cgal_mesh.h"

namespace lodestone::bench {

namespace {

double simplify(const Job& job, PeerMesh& out) {
    return simplifyWithCgal(job, out, [](CgalMesh& mesh, const StopAtFaces& stop) {
        CGAL::Surface_mesh_simplification::edge_collapse(mesh, stop);
    });
}

} // namespace

MeshPeer cgalLindstromTurkPeer() {
    return oneByOne("CGAL " CGAL_VERSION_STR " Lindstrom–Turk", Welding::Positions, simplify);
}

} // namespace lodestone::bench
