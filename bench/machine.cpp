#include "bench/machine.h"

#include "bench/peers/process.h"

#include <array>
#include <cstdlib>
#include <fmt/core.h>
#include <fstream>
#include <sys/utsname.h>
#include <thread>

namespace lodestone::bench {

namespace {

// What follows the separator in the first line of a file that starts so; empty if none does.
std::string fieldOf(const char* path, const std::string& start, char separator) {
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);)
        if (line.starts_with(start)) {
            std::string value = line.substr(line.find(separator) + 1);
            value.erase(0, value.find_first_not_of(" \t"));
            return value;
        }
    return {};
}

std::string unquoted(std::string text) {
    std::erase(text, '"');
    return text;
}

std::string compilerText() {
#if defined(__clang__)
    return "Clang " __clang_version__;
#else
    return "GCC " __VERSION__;
#endif
}

std::string memoryText() {
    const std::string kilobytes = fieldOf("/proc/meminfo", "MemTotal", ':');
    const double bytes = 1024.0 * std::strtod(kilobytes.c_str(), nullptr);
    return fmt::format("{:.1f} GiB", bytes / (1024.0 * 1024.0 * 1024.0));
}

std::string loadText() {
    std::array<double, 3> loads{};
    if (getloadavg(loads.data(), 3) != 3)
        return "unknown";
    return fmt::format("{:.2f} {:.2f} {:.2f}", loads[0], loads[1], loads[2]);
}

std::string firstLine(const std::string& text) {
    return text.substr(0, text.find('\n'));
}

} // namespace

std::string machineText() {
    utsname system{};
    uname(&system);
    const Result<Ran> node = runProgram({"node", "--version"});
    return fmt::format("- processor: {}, {} hardware threads; memory: {}\n"
                       "- system: {}, Linux {}\n"
                       "- compiler: {}; Node.js: {}\n"
                       "- load averages before the run: {}\n",
                       fieldOf("/proc/cpuinfo", "model name", ':'),
                       std::thread::hardware_concurrency(),
                       memoryText(),
                       unquoted(fieldOf("/etc/os-release", "PRETTY_NAME", '=')),
                       system.release,
                       compilerText(),
                       node ? firstLine(node->output) : "none",
                       loadText());
}

std::string commitText() {
    const Result<Ran> commit = runProgram(
        {"git", "-C", LODESTONE_SOURCE_DIR, "log", "-1", "--format=%h of %cd, %s", "--date=short"});
    // What a run writes does not count as a change.
    const Result<Ran> changes = runProgram({"git",
                                            "-C",
                                            LODESTONE_SOURCE_DIR,
                                            "status",
                                            "--porcelain",
                                            "--untracked-files=no",
                                            "--",
                                            ".",
                                            ":!bench/RESULTS.md",
                                            ":!bench/peers.csv"});
    if (!commit || !changes)
        return "unknown";
    return firstLine(commit->output) + (changes->output.empty() ? "" : " (with changes)");
}

} // namespace lodestone::bench
