#pragma once
// Plans nodes, scenes and the ways instances can be stored.
#include "scene/gltf/export_plan.h"

#include <set>

namespace lodestone {

// Fills nodes, scenes, groups, instances and what SubmeshPlan knows of them.
// document: the source's, references already rewritten. wanted: nodes that something refers to.
void planInstances(ExportPlan& plan,
                   nlohmann::json& document,
                   const std::set<std::uint32_t>& wanted);

} // namespace lodestone
