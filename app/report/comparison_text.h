#pragma once
// A comparison for terminals, machines and spreadsheets.
#include "app/report/comparison.h"

namespace lodestone {

// Aligned columns, the original first, then a line for every note and every missed target.
std::string comparisonTable(const Comparison& comparison);
// One object: "original" and "rows"; ends with a line break.
std::string comparisonJson(const Comparison& comparison);
// RFC 4180, a line of names first, then the original, then the rows. Missing numbers are empty.
std::string comparisonCsv(const Comparison& comparison);

// "original", or the id of the algorithm.
std::string_view rowId(const ComparisonRow& row);
// "20 % of the triangles", "at most 300,000 bytes"
std::string targetText(const Target& target);
// "the target is missed: 12 % above"; "18 % below the target"; empty within 1 %.
std::string deviationText(const Comparison& comparison, const ComparisonRow& row);

} // namespace lodestone
