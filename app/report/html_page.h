#pragma once
#include "app/report/comparison.h"

namespace lodestone {

// The comparison as one HTML page: pictures, tables, charts, notes. It needs no other file and asks
// the network for nothing; light or dark as the reader's system is, with a switch. Every text that
// comes from a file is escaped. Well-formed XML.
std::string comparisonPage(const Comparison& comparison);

} // namespace lodestone
