#include "bench/peers/files.h"

#include "bench/peers/npm.h"
#include "bench/peers/process.h"

#include <fmt/core.h>

namespace lodestone::bench {

Result<double> FilePeer::run(const std::filesystem::path& in,
                             const std::filesystem::path& out) const {
    const std::filesystem::path between = out.parent_path() / "between.glb";
    double seconds = 0.0;
    for (std::vector<std::string> command : commands) {
        for (std::string& word : command) {
            if (word == "IN")
                word = in.string();
            else if (word == "OUT")
                word = out.string();
            else if (word == "BETWEEN")
                word = between.string();
        }
        const Result<Ran> ran = runProgram(command);
        if (!ran)
            return tl::unexpected(ran.error());
        seconds += ran->seconds;
    }
    return seconds;
}

namespace {

using Words = std::vector<std::string>;

FilePeer gltfpack(const std::string& name, Words program, const std::string& options) {
    for (const char* word : {"-i", "IN", "-o", "OUT"})
        program.emplace_back(word);
    for (std::size_t begin = 0; begin < options.size();) {
        const std::size_t end = std::min(options.find(' ', begin), options.size());
        program.push_back(options.substr(begin, end - begin));
        begin = end + 1;
    }
    return {name + " " + options, {program}};
}

void addGltfpackOfDebian(FilePeers& peers, const std::string& ratio) {
    const Result<Ran> version = runProgram({"gltfpack", "-v"});
    if (!version) {
        peers.absent.push_back({"gltfpack of Debian", "not installed: install gltfpack"});
        return;
    }
    const std::string name = version->output.substr(0, version->output.find('\n'));
    for (const char* options : {" -noq", " -mi -noq", " -mi"})
        peers.present.push_back(gltfpack(name, {"gltfpack"}, "-si " + ratio + options));
}

void addGltfpackOfNpm(FilePeers& peers, const std::string& npm, const std::string& ratio) {
    const Result<std::string> version = npmVersion(npm, "gltfpack");
    if (!version) {
        peers.absent.push_back({"gltfpack of npm", version.error().message});
        return;
    }
    for (const char* options : {" -se 1 -mi -noq", " -se 1 -sp -mi -noq", " -se 1 -mi -cc"})
        peers.present.push_back(gltfpack("gltfpack " + *version + " (npm)",
                                         {"node", npm + "/gltfpack/cli.js"},
                                         "-si " + ratio + options));
}

void addGltfTransform(FilePeers& peers, const std::string& npm, const std::string& ratio) {
    const Result<std::string> version = npmVersion(npm, "@gltf-transform/cli");
    if (!version) {
        peers.absent.push_back({"glTF-Transform", version.error().message});
        return;
    }
    const std::string program = npm + "/@gltf-transform/cli/bin/cli.js";
    peers.present.push_back(
        {fmt::format("glTF-Transform {} (npm) weld, simplify --ratio {}", *version, ratio),
         {{"node", program, "weld", "IN", "BETWEEN"},
          {"node", program, "simplify", "BETWEEN", "OUT", "--ratio", ratio, "--error", "1"}}});
}

} // namespace

FilePeers filePeers(const std::string& npm, double ratio) {
    FilePeers peers;
    const std::string text = fmt::format("{}", ratio);
    addGltfpackOfDebian(peers, text);
    addGltfpackOfNpm(peers, npm, text);
    addGltfTransform(peers, npm, text);
    return peers;
}

} // namespace lodestone::bench
