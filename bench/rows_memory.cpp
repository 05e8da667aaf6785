#include "bench/rows.h"
#include "simplify/quadric/quadric.h"

#include <array>
#include <cstdio>
#include <fcntl.h>
#include <fmt/core.h>
#include <fstream>
#include <iostream>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

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

// Runs this program with one argument and returns the first line that it prints.
Result<std::string> runSelf(const std::string& argument) {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0)
        return fail(ErrorKind::Failed, "memory: no pipe for the child process");
    posix_spawn_file_actions_t actions{};
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    std::string program = "/proc/self/exe";
    std::string option = argument;
    const std::array<char*, 3> arguments{program.data(), option.data(), nullptr};
    pid_t child = 0;
    const int failed =
        posix_spawn(&child, program.c_str(), &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    std::string line;
    char letter = 0;
    while (failed == 0 && read(ends[0], &letter, 1) == 1 && letter != '\n')
        line += letter;
    close(ends[0]);
    int status = 0;
    if (failed != 0 || waitpid(child, &status, 0) != child || status != 0)
        return fail(ErrorKind::Failed, "memory: the child process failed");
    return line;
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
    const Result<std::string> printed = runSelf("--memory-child");
    if (!printed)
        return tl::unexpected(printed.error());
    const double peak = std::stod("0" + *printed) / kGibibyte;
    if (peak == 0.0)
        return fail(ErrorKind::Failed, "memory: this system does not tell the peak of a process");
    bench.table.atMost("maple expanded, Quadric, down to 20 %: peak resident memory",
                       {peak, 1.5, fmt::format("{:.2f} GiB", peak), "1.5 GiB", ""});
    return {};
}

} // namespace lodestone::bench
