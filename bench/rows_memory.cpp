#include "bench/peers/process.h"
#include "bench/rows.h"
#include "simplify/quadric/quadric.h"

#include <fmt/core.h>
#include <fstream>
#include <iostream>

namespace lodestone::bench {

namespace {

// The most memory this process has had resident, bytes; 0 if unknown. Not getrusage's number: that
// one remembers what the parent had when it started the process.
std::uint64_t peakMemoryBytes() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with("VmHWM:"))
            return 1024 * std::stoull(line.substr(6));
    return 0;
}

} // namespace

int runMemoryChild() {
    Inputs inputs({}, {});
    const Result<ScenePtr> maple = inputs.own("maple");
    if (!maple)
        return exitCode(maple.error().kind);
    const Result<LodSourcePtr> source = quadricAlgorithm().prepare(*maple, {}, {}, {});
    if (!source)
        return exitCode(source.error().kind);
    const ByteModel bytes((*source)->scene(), ExportOptions{});
    const Resolved at = (*source)->resolve({Target::Kind::Ratio, 0.2}, bytes);
    const Lod lod = (*source)->readOut(at.position, nullptr);
    std::cout << peakMemoryBytes() << std::endl;
    return lod.triangles > 0 ? 0 : 1;
}

Result<void> addMemoryRows(Bench& bench) {
    constexpr double kGibibyte = 1024.0 * 1024.0 * 1024.0;
    const Result<Ran> child = runProgram({"/proc/self/exe", "--memory-child"});
    if (!child)
        return tl::unexpected(child.error());
    const double peak = std::stod("0" + child->output) / kGibibyte;
    if (peak == 0.0)
        return fail(ErrorKind::Failed, "memory: this system does not tell the peak of a process");
    bench.table.atMost("maple expanded, Quadric, down to 20 %: peak resident memory",
                       {peak, 1.5, fmt::format("{:.2f} GiB", peak), "1.5 GiB", ""});
    return {};
}

} // namespace lodestone::bench
