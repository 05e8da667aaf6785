#pragma once
// Programs that make one file of another.
#include "bench/peers/peer.h"

#include <filesystem>

namespace lodestone::bench {

struct FilePeer {
    std::string name; // with its version and options
    // Run one after the other; the words IN, OUT and BETWEEN stand for files. BETWEEN is a .glb
    // that the first one writes and the next one reads.
    std::vector<std::vector<std::string>> commands;

    // CPU seconds of all commands, from reading `in` to writing `out`.
    // Errors: those of runProgram.
    Result<double> run(const std::filesystem::path& in, const std::filesystem::path& out) const;
};

struct FilePeers {
    std::vector<FilePeer> present;
    std::vector<AbsentPeer> absent;
};

// To a ratio of the triangles. npm: folder of installed npm modules, may be absent.
FilePeers filePeers(const std::string& npm, double ratio);

} // namespace lodestone::bench
