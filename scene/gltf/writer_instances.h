#pragma once
// Plans the ways instances can be stored.
#include "scene/gltf/export_plan.h"

namespace lodestone {

// Fills groups and instances; adds nodes for what is not a node in the file. planNodes() has run.
// document: the source's, references already rewritten.
// Returns the added nodes that belong to the drawn scene's roots.
std::vector<std::uint32_t> planInstances(ExportPlan& plan, nlohmann::json& document);

// Fills in what SubmeshPlan knows of sizes. Everything else is planned.
void estimateInstances(ExportPlan& plan);

} // namespace lodestone
