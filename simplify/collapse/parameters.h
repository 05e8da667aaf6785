#pragma once
// Parameters that the edge-collapse methods have in common.
#include "simplify/algorithm.h"
#include "simplify/collapse/edge_collapse_source.h"

namespace lodestone {

std::vector<ParameterInfo> collapseParameters();
// For methods that keep instances: whether they thin them out, and by which rule.
ParameterInfo removalParameter();
ParameterInfo removalRuleParameter();

// Options of an edge-collapse row from its values. Errors: Usage, naming the parameter.
Result<EdgeCollapseOptions> readCollapseParameters(const Algorithm& algorithm,
                                                   const ParameterValues& values);

} // namespace lodestone
