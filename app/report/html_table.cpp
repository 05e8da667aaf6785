#include "app/report/html_table.h"

#include "app/report/comparison_text.h"
#include "app/report/html_sections.h"
#include "app/report/html_text.h"

#include <algorithm>
#include <fmt/core.h>

namespace lodestone {

namespace {

constexpr std::string_view kMissing = "<span class=\"quiet\">–</span>";

std::vector<const ComparisonRow*> allRows(const Comparison& comparison) {
    std::vector<const ComparisonRow*> rows{&comparison.original};
    for (const ComparisonRow& row : comparison.rows)
        rows.push_back(&row);
    return rows;
}

// The best value among the algorithms as the column shows it; empty where fewer than two compete,
// or all look equal.
std::string bestOf(const Comparison& comparison, const Column& column) {
    if (column.better == Better::Neither)
        return {};
    std::vector<double> values;
    for (const ComparisonRow* row : competingRows(comparison))
        if (const std::optional<double> value = column.value(*row))
            values.push_back(*value);
    if (values.size() < 2)
        return {};
    const auto [least, most] = std::ranges::minmax(values);
    if (column.text(least) == column.text(most))
        return {};
    return column.text(column.better == Better::Less ? least : most);
}

std::string numberCell(const ComparisonRow& row, const Column& column, const std::string& best) {
    const std::optional<double> value = column.value(row);
    if (!value)
        return fmt::format("<td>{}</td>", kMissing);
    const std::string text = column.text(*value);
    const bool wins = row.algorithm && !best.empty() && text == best;
    return fmt::format("<td{}>{}</td>", wins ? " class=\"best\"" : "", text);
}

std::string rowHead(const Comparison& comparison, const ComparisonRow& row) {
    const std::string remark = row.failed() ? "failed" : deviationText(comparison, row);
    const bool warns = row.failed() || !row.outcome.target_met;
    return fmt::format("<th scope=\"row\">{}{}</th>",
                       rowSwatch(row),
                       remark.empty() ? std::string()
                                      : fmt::format("<small class=\"{}\">{}</small>",
                                                    warns ? "warning" : "quiet",
                                                    escaped(remark)));
}

std::string tableRow(const Comparison& comparison,
                     const ComparisonRow& row,
                     const Table& table,
                     const std::vector<std::string>& best) {
    std::string cells = rowHead(comparison, row);
    if (row.failed()) {
        const std::size_t width = table.columns.size() + (table.bar ? 1 : 0);
        cells += fmt::format(
            "<td class=\"failure\" colspan=\"{}\">{}</td>", width, escaped(row.failure));
    } else {
        if (table.bar)
            cells += fmt::format("<td class=\"bar-cell\">{}</td>", table.bar(row));
        for (std::size_t i = 0; i < table.columns.size(); ++i)
            cells += numberCell(row, table.columns[i], best[i]);
    }
    return fmt::format("<tr data-algorithm=\"{}\">{}</tr>\n", escaped(rowId(row)), cells);
}

} // namespace

std::string tableSection(const Comparison& comparison, const Table& table) {
    std::string heads = "<th scope=\"col\">Algorithm</th>";
    if (table.bar)
        heads += fmt::format("<th scope=\"col\" class=\"bar-cell\">{}</th>", table.bar_name);
    std::vector<std::string> best;
    for (const Column& column : table.columns) {
        heads += fmt::format("<th scope=\"col\" title=\"{}\">{}</th>", column.tooltip, column.name);
        best.push_back(bestOf(comparison, column));
    }
    std::string body;
    for (const ComparisonRow* row : allRows(comparison))
        body += tableRow(comparison, *row, table, best);
    return fmt::format(R"(<section aria-labelledby="{0}">
<h2 id="{0}">{1}</h2>
{2}<div class="scroll" role="region" tabindex="0" aria-labelledby="{0}">
<table>
<thead><tr>{3}</tr></thead>
<tbody>
{4}</tbody>
</table>
</div>
</section>
)",
                       table.id,
                       table.title,
                       table.lead.empty() ? std::string()
                                          : fmt::format("<p class=\"quiet\">{}</p>\n", table.lead),
                       heads,
                       body);
}

std::string stackedBar(const std::vector<Part>& parts, double longest) {
    constexpr double kSmallestShown = 0.05; // per cent
    std::string segments;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const double share = longest > 0.0 ? 100.0 * parts[i].value / longest : 0.0;
        if (share >= kSmallestShown)
            segments +=
                fmt::format("<i class=\"part-{}\" style=\"width:{:.2f}%\" title=\"{}: {}\"></i>",
                            i + 1,
                            share,
                            parts[i].name,
                            parts[i].text);
    }
    return fmt::format("<span class=\"bar\" aria-hidden=\"true\">{}</span>", segments);
}

} // namespace lodestone
