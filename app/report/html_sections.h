#pragma once
// The parts of the page. Each returns whole elements, well-formed XML.
#include "app/report/comparison.h"

namespace lodestone {

// What every part says alike of a row.
std::string rowName(const ComparisonRow& row);   // "Original", "IAS"; escaped
std::string rowStyle(const ComparisonRow& row);  // attribute value that colours it
std::string rowSwatch(const ComparisonRow& row); // coloured dot and name
double shareOf(const Comparison& comparison, const ComparisonRow& row); // of the triangles, 0..1
// The original, then the rows that did not fail.
std::vector<const ComparisonRow*> shownRows(const Comparison& comparison);

std::string picturesSection(const Comparison& comparison);
std::string tablesSection(const Comparison& comparison);
std::string chartsSection(const Comparison& comparison);

std::string pageStyle(); // CSS
std::string pageScript();

} // namespace lodestone
