#pragma once
// Times told in those of a reference kernel of the same run, and compared with a run before.
#include "bench/timing.h"

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace lodestone::bench {

constexpr double kSlowerBy = 1.25; // of the ratio before: what counts as slower

struct HotPath {
    std::string name;
    Spread seconds;     // CPU, of one iteration, over the repetitions
    double ratio = 0.0; // median over the reference kernel's
};

using Ratios = std::map<std::string, double>; // name -> ratio

// Errors: BadInput naming the file if it is not an object of positive numbers.
Result<Ratios> readBaseline(const std::filesystem::path& path);
// Errors: Failed naming the file.
Result<void> writeBaseline(const std::filesystem::path& path, std::span<const HotPath> paths);

// Those that take more than kSlowerBy of their ratio before. What is new is not slower.
std::vector<std::string> slowerThan(const Ratios& baseline, std::span<const HotPath> paths);

// Markdown table; baseline: empty if there is none.
std::string ratioTable(std::span<const HotPath> paths, const Ratios& baseline);

} // namespace lodestone::bench
