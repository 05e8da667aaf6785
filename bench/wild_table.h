#pragma once
// Wild beside Quadric: distance over the models of many parts, colour over the textured ones, and
// how time grows.
#include "bench/figures.h"

#include <filesystem>

namespace lodestone::bench {

struct WildTable {
    std::string markdown;
};

// Models whose name passes, at 10, 1 and 0.1 % of their triangles. What fails is told on stderr and
// named in its row. Returns the exit code.
int addWildTable(WildTable& table, Inputs& inputs, const TitleFilter& wanted);

} // namespace lodestone::bench
