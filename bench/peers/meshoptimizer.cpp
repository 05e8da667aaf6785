#include "bench/peers/peer.h"
#include "bench/timing.h"

#include <meshoptimizer.h>

namespace lodestone::bench {

namespace {

constexpr float kNoErrorLimit = 1e10F;

// reduce(mesh, indices): writes the kept indices, returns how many. The call alone is timed.
template <class Reduce>
double reduceIndices(const Job& job, PeerMesh& out, const Reduce& reduce) {
    const PeerMesh& mesh = *job.mesh;
    out.positions = mesh.positions;
    out.indices.resize(mesh.indices.size());
    const double start = cpuSeconds();
    const std::size_t kept = reduce(mesh, out.indices.data());
    const double seconds = cpuSeconds() - start;
    out.indices.resize(kept);
    return seconds;
}

double simplify(const Job& job, PeerMesh& out) {
    return reduceIndices(job, out, [&](const PeerMesh& mesh, std::uint32_t* indices) {
        return meshopt_simplify(indices,
                                mesh.indices.data(),
                                mesh.indices.size(),
                                &mesh.positions.front().x,
                                mesh.positions.size(),
                                sizeof(glm::vec3),
                                3 * job.triangle_target,
                                kNoErrorLimit,
                                0,
                                nullptr);
    });
}

double simplifySloppy(const Job& job, PeerMesh& out) {
    return reduceIndices(job, out, [&](const PeerMesh& mesh, std::uint32_t* indices) {
        return meshopt_simplifySloppy(indices,
                                      mesh.indices.data(),
                                      mesh.indices.size(),
                                      &mesh.positions.front().x,
                                      mesh.positions.size(),
                                      sizeof(glm::vec3),
                                      3 * job.triangle_target,
                                      kNoErrorLimit,
                                      nullptr);
    });
}

} // namespace

std::vector<MeshPeer> meshoptimizerPeers() {
    const std::string name = "meshoptimizer " + std::to_string(MESHOPTIMIZER_VERSION / 1000) + "." +
                             std::to_string(MESHOPTIMIZER_VERSION % 1000 / 10);
    return {oneByOne(name + " simplify, as stored", Welding::AsStored, simplify),
            oneByOne(name + " simplify, welded", Welding::Positions, simplify),
            oneByOne(name + " simplifySloppy", Welding::AsStored, simplifySloppy)};
}

} // namespace lodestone::bench
