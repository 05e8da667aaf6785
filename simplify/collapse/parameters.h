#pragma once
// Parameters that the edge-collapse methods have in common.
#include "simplify/algorithm.h"
#include "simplify/collapse/edge_collapse_source.h"

namespace lodestone {

std::vector<ParameterInfo> collapseParameters();
// For methods that keep instances: whether they thin them out.
ParameterInfo removalParameter();
// That, by which rule, and from which shape on.
void addRemovalParameters(std::vector<ParameterInfo>& parameters);

// Options of an edge-collapse row from its values. Errors: Usage, naming the parameter.
Result<EdgeCollapseOptions> readCollapseParameters(const Algorithm& algorithm,
                                                   const ParameterValues& values);

} // namespace lodestone
