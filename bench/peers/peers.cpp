#include "bench/peers/peer.h"

#include <exception>

namespace lodestone::bench {

MeshPeer oneByOne(const std::string& name, Welding welding, SimplifyOne simplify) {
    return {name, welding, [name, simplify](std::span<const Job> jobs) -> Result<Reduced> {
                Reduced reduced;
                try {
                    for (const Job& job : jobs)
                        reduced.seconds += simplify(job, reduced.meshes.emplace_back());
                } catch (const std::exception& exception) {
                    return fail(ErrorKind::Failed, name + ": " + exception.what());
                }
                return reduced;
            }};
}

namespace {

void addOpenMesh(MeshPeers& peers) {
#ifdef LODESTONE_WITH_OPENMESH
    peers.present.push_back(openMeshPeer());
#else
    peers.absent.push_back({"OpenMesh", "not found by CMake: install libopenmesh-dev"});
#endif
}

void addCgal(MeshPeers& peers) {
#ifdef LODESTONE_WITH_CGAL
    peers.present.push_back(cgalLindstromTurkPeer());
    peers.present.push_back(cgalGarlandHeckbertPeer());
#else
    peers.absent.push_back({"CGAL", "not found by CMake: install libcgal-dev and libeigen3-dev"});
#endif
}

void addVtk(MeshPeers& peers) {
#ifdef LODESTONE_WITH_VTK
    peers.present.push_back(vtkQuadricPeer());
#else
    peers.absent.push_back({"VTK", "not found by CMake: install libvtk9-dev"});
#endif
}

} // namespace

MeshPeers meshPeers(const std::string& npm) {
    MeshPeers peers{meshoptimizerPeers(), {}};
    addOpenMesh(peers);
    addCgal(peers);
    addVtk(peers);
    Result<MeshPeer> web_assembly = webAssemblyPeer(npm);
    if (web_assembly)
        peers.present.push_back(std::move(*web_assembly));
    else
        peers.absent.push_back({"meshoptimizer of npm", web_assembly.error().message});
    return peers;
}

} // namespace lodestone::bench
