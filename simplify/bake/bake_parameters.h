#pragma once
// Parameters by which a row of the algorithm table offers texture transfer.
#include "simplify/algorithm.h"
#include "simplify/bake/bake_options.h"

namespace lodestone {

// Appends texture=keep|transfer and, for transfer, atlas, merge-materials, atlas-format and
// jpeg-quality. None of them changes the LODs themselves.
void addBakeParameters(std::vector<ParameterInfo>& parameters);

// What the values of a row ask for; nullopt: textures are kept, or the row cannot transfer any.
std::optional<BakeOptions> bakeOptions(const Algorithm& algorithm, const ParameterValues& values);

} // namespace lodestone
