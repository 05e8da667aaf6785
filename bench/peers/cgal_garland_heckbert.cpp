// CGAL's edge collapse with plane quadrics (Garland and Heckbert 1997), normals bounded.
#include "bench/peers/cgal_mesh.h"

#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_placement.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>

namespace lodestone::bench {

namespace {

namespace collapse = CGAL::Surface_mesh_simplification;

double simplify(const Job& job, PeerMesh& out) {
    return simplifyWithCgal(job, out, [](CgalMesh& mesh, const StopAtFaces& stop) {
        using Policies = collapse::GarlandHeckbert_plane_policies<CgalMesh, CgalKernel>;
        const Policies policies(mesh);
        using Placement = collapse::Bounded_normal_change_placement<Policies::Get_placement>;
        collapse::edge_collapse(mesh,
                                stop,
                                CGAL::parameters::get_cost(policies.get_cost())
                                    .get_placement(Placement(policies.get_placement())));
    });
}

} // namespace

MeshPeer cgalGarlandHeckbertPeer() {
    return oneByOne(
        "CGAL " CGAL_VERSION_STR " Garland–Heckbert plane", Welding::Positions, simplify);
}

} // namespace lodestone::bench
