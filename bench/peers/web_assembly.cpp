#include "bench/peers/npm.h"
#include "bench/peers/peer.h"
#include "bench/peers/process.h"

#include <charconv>
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

void writeJobs(const std::filesystem::path& path, std::span<const Job> jobs) {
    std::ofstream file(path, std::ios::binary);
    put(file, jobs.size());
    for (const Job& job : jobs) {
        put(file, job.mesh->positions.size());
        put(file, job.mesh->indices.size());
        put(file, 3 * job.triangle_target);
        file.write(reinterpret_cast<const char*>(job.mesh->positions.data()),
                   static_cast<std::streamsize>(job.mesh->positions.size() * sizeof(glm::vec3)));
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

Result<Reduced> simplifyInNode(const std::string& npm, std::span<const Job> jobs) {
    const ScratchFolder scratch;
    const std::filesystem::path in = scratch.path() / "jobs.bin";
    const std::filesystem::path out = scratch.path() / "reduced.bin";
    writeJobs(in, jobs);
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

Result<MeshPeer> webAssemblyPeer(const std::string& npm) {
    const Result<std::string> version = npmVersion(npm, "meshoptimizer");
    if (!version)
        return tl::unexpected(version.error());
    return MeshPeer{"meshoptimizer " + *version + " (npm, WebAssembly) simplify, as stored",
                    Welding::AsStored,
                    [npm](std::span<const Job> jobs) { return simplifyInNode(npm, jobs); }};
}

} // namespace lodestone::bench
