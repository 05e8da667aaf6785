#include "bench/peers/npm.h"
#include "bench/peers/peer.h"
#include "bench/peers/process.h"

#include <algorithm>
#include <charconv>
#include <fmt/core.h>
#include <fstream>

namespace lodestone::bench {

namespace {

// The format of simplify.mjs: little-endian 32-bit words.
void put(std::ofstream& file, std::span<const std::uint32_t> words) {
    file.write(reinterpret_cast<const char*>(words.data()),
               static_cast<std::streamsize>(words.size_bytes()));
}

void put(std::ofstream& file, std::size_t word) {
    const auto narrow = static_cast<std::uint32_t>(word);
    put(file, std::span(&narrow, 1));
}

void put(std::ofstream& file, std::span<const float> numbers) {
    file.write(reinterpret_cast<const char*>(numbers.data()),
               static_cast<std::streamsize>(numbers.size_bytes()));
}

using Weights = std::array<float, PeerWeights::kValues>;

bool anyOf(const Weights& weights) {
    return std::ranges::any_of(weights, [](float weight) { return weight > 0.0f; });
}

void writeJobs(const std::filesystem::path& path,
               std::span<const Job> jobs,
               const Weights& weights) {
    std::ofstream file(path, std::ios::binary);
    put(file, jobs.size());
    put(file, weights);
    for (const Job& job : jobs) {
        put(file, job.mesh->positions.size());
        put(file, job.mesh->indices.size());
        put(file, 3 * job.triangle_target);
        file.write(reinterpret_cast<const char*>(job.mesh->positions.data()),
                   static_cast<std::streamsize>(job.mesh->positions.size() * sizeof(glm::vec3)));
        if (anyOf(weights))
            put(file, job.mesh->attributes);
        put(file, job.mesh->indices);
    }
}

// Errors: Failed where the file is cut short or claims more than it was given.
Result<Reduced> readReduced(const std::filesystem::path& path, std::span<const Job> jobs) {
    std::ifstream file(path, std::ios::binary);
    Reduced reduced;
    for (const Job& job : jobs) {
        std::uint32_t index_count = 0;
        file.read(reinterpret_cast<char*>(&index_count), sizeof index_count);
        if (!file || index_count > job.mesh->indices.size())
            return fail(ErrorKind::Failed, "node: its answer cannot be read");
        PeerMesh& made = reduced.meshes.emplace_back();
        made.positions = job.mesh->positions;
        made.indices.resize(index_count);
        file.read(reinterpret_cast<char*>(made.indices.data()),
                  static_cast<std::streamsize>(index_count * sizeof(std::uint32_t)));
        if (!file)
            return fail(ErrorKind::Failed, "node: its answer is cut short");
    }
    return reduced;
}

Result<Reduced>
simplifyInNode(const std::string& npm, std::span<const Job> jobs, const Weights& weights) {
    const ScratchFolder scratch;
    const std::filesystem::path in = scratch.path() / "jobs.bin";
    const std::filesystem::path out = scratch.path() / "reduced.bin";
    writeJobs(in, jobs, weights);
    const std::string script = std::string(LODESTONE_SOURCE_DIR) + "/bench/peers/simplify.mjs";
    const Result<Ran> ran = runProgram({"node", script, npm, in.string(), out.string()});
    if (!ran)
        return tl::unexpected(ran.error());
    Result<Reduced> reduced = readReduced(out, jobs);
    if (reduced)
        std::from_chars(
            ran->output.data(), ran->output.data() + ran->output.size(), reduced->seconds);
    return reduced;
}

} // namespace

Result<MeshPeer> webAssemblyPeer(const std::string& npm, const PeerWeights& weights) {
    const Result<std::string> version = npmVersion(npm, "meshoptimizer");
    if (!version)
        return tl::unexpected(version.error());
    const Weights values = weights.perValue();
    const std::string call =
        anyOf(values) ? fmt::format("simplifyWithAttributes (normals {:g}, colours {:g}, texture "
                                    "coordinates {:g})",
                                    weights.normal,
                                    weights.color,
                                    weights.texcoord)
                      : "simplify";
    return MeshPeer{
        "meshoptimizer " + *version + " (npm, WebAssembly) " + call + ", as stored",
        Welding::AsStored,
        [npm, values](std::span<const Job> jobs) { return simplifyInNode(npm, jobs, values); }};
}

} // namespace lodestone::bench
