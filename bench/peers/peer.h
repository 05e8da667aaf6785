#pragma once
// Simplifiers of other people, as packages provide them. Each is there or not, by what was found
// when the bench was built or is found when it runs.
#include "scene/result.h"

#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lodestone::bench {

// What attributes count for a peer that heeds them: each value's weight.
struct PeerWeights {
    static constexpr std::size_t kValues = 8; // normal, colour, texture coordinates
    float normal = 0.0f;
    float color = 0.0f;
    float texcoord = 0.0f;

    std::array<float, kValues> perValue() const {
        return {normal, normal, normal, color, color, color, texcoord, texcoord};
    }
};

// A triangle list as the packages take it.
struct PeerMesh {
    std::vector<glm::vec3> positions;
    std::vector<std::uint32_t> indices; // [3 * triangles]
    // [PeerWeights::kValues * vertices], 0 where the mesh has none; empty where vertices are
    // welded.
    std::vector<float> attributes = {};

    std::size_t triangleCount() const { return indices.size() / 3; }
};

// What a peer is given.
enum class Welding : std::uint8_t {
    AsStored,  // vertices as the file has them: seams of attributes hold it up. Vertices stay.
    Positions, // equal positions are one vertex, degenerate triangles are gone
};

struct Job {
    const PeerMesh* mesh = nullptr;
    std::size_t triangle_target = 0;
};

struct Reduced {
    std::vector<PeerMesh> meshes; // [jobs]
    double seconds = 0.0;         // CPU of the calls alone; making a package's own mesh not counted
};

// Something that simplifies meshes, one after the other. Deterministic but for the time.
struct MeshPeer {
    std::string name; // with its version
    Welding welding = Welding::Positions;
    std::function<Result<Reduced>(std::span<const Job>)> simplify;
};

// A peer that is not there, and what would bring it.
struct AbsentPeer {
    std::string name;
    std::string why;
};

struct MeshPeers {
    std::vector<MeshPeer> present;
    std::vector<AbsentPeer> absent;
};

// npm: folder of installed npm modules, may be absent.
MeshPeers meshPeers(const std::string& npm);

// One mesh; returns CPU seconds of the call and leaves the result in `out`. Throws what it throws.
using SimplifyOne = double (*)(const Job& job, PeerMesh& out);
// A peer that takes meshes one by one. What it throws becomes an Error.
MeshPeer oneByOne(const std::string& name, Welding welding, SimplifyOne simplify);

// Those that are linked; only where CMake found the package.
std::vector<MeshPeer> meshoptimizerPeers();
MeshPeer openMeshPeer();
MeshPeer cgalLindstromTurkPeer();
MeshPeer cgalGarlandHeckbertPeer();
MeshPeer vtkQuadricPeer();
// npm's meshoptimizer, compiled to WebAssembly; runs in a node process of its own. All weights 0:
// its simplify, else its simplifyWithAttributes.
Result<MeshPeer> webAssemblyPeer(const std::string& npm, const PeerWeights& weights = {});

} // namespace lodestone::bench
