#pragma once
// Other programs, run and timed.
#include "scene/result.h"

#include <filesystem>
#include <string>
#include <vector>

namespace lodestone::bench {

struct Ran {
    double seconds = 0.0; // CPU of the process and of those it waited for, all threads
    std::string output;   // its stdout
};

// Runs a program to its end; found on PATH unless it names a folder. stdin and stderr are empty.
// Errors: Failed if it cannot be started or does not exit with 0, naming it.
Result<Ran> runProgram(const std::vector<std::string>& arguments);

// A folder for files that goes when the guard does.
class ScratchFolder {
public:
    ScratchFolder();
    ~ScratchFolder();
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

} // namespace lodestone::bench
