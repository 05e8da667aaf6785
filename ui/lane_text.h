#pragma once
// Words about a lane.
#include "app/document.h"

#include <string>

namespace lodestone::ui {

std::string_view orderingName(Ordering ordering); // "triangle", "byte", "cost"
// What stands behind the name in a view's header: the file for Original, else what sets the lane
// apart: "per triangle", "expanded", changed parameters.
std::string laneSummary(const Document& document, const Lane& lane);
std::string_view instancingName(Instancing instancing); // "GLB · automatic" without container
std::string sceneTitle(const Document& document);       // file name or sample name
double frameMilliseconds(const Lane& lane); // measured, else of the last draw; 0: unknown
double framesPerSecond(const Lane& lane);   // by it

} // namespace lodestone::ui
