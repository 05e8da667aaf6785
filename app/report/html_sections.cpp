#include "app/report/html_sections.h"

#include "app/report/html_text.h"

#include <algorithm>
#include <fmt/core.h>

namespace lodestone {

std::string rowName(const ComparisonRow& row) {
    return row.algorithm ? escaped(row.algorithm->short_name) : std::string("Original");
}

std::string rowStyle(const ComparisonRow& row) {
    return laneStyle(row.algorithm);
}

std::string rowSwatch(const ComparisonRow& row) {
    return fmt::format(
        "<span class=\"swatch lane\" style=\"{}\">{}</span>", rowStyle(row), rowName(row));
}

double shareOf(const Comparison& comparison, const ComparisonRow& row) {
    const std::uint64_t all = comparison.original.outcome.lod->triangles;
    return static_cast<double>(row.outcome.lod->triangles) /
           static_cast<double>(std::max<std::uint64_t>(all, 1));
}

std::vector<const ComparisonRow*> shownRows(const Comparison& comparison) {
    std::vector<const ComparisonRow*> rows{&comparison.original};
    for (const ComparisonRow& row : comparison.rows)
        if (!row.failed())
            rows.push_back(&row);
    return rows;
}

} // namespace lodestone
