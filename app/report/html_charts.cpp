#include "app/cli_report.h"
#include "app/report/html_sections.h"
#include "app/report/html_text.h"
#include "app/report/svg_chart.h"

#include <fmt/core.h>

namespace lodestone {

namespace {

using Coordinate = double (*)(const CurvePoint&);

double trianglesOf(const CurvePoint& point) {
    return static_cast<double>(point.triangles);
}

double bytesOf(const CurvePoint& point) {
    return static_cast<double>(point.bytes);
}

double meanOf(const CurvePoint& point) {
    return point.mean;
}

double hausdorffOf(const CurvePoint& point) {
    return point.hausdorff;
}

struct ChartPlan {
    std::string_view title;
    std::string_view summary;
    ChartAxis x;
    ChartAxis y;
    Coordinate x_of;
    Coordinate y_of;
    bool original_line; // of its bytes
};

ChartPoint chartPoint(const ChartPlan& plan, const CurvePoint& point) {
    return {plan.x_of(point),
            plan.y_of(point),
            fmt::format("{} triangles\n{}\nmean {:.4g} %, Hausdorff {:.4g} %",
                        thousands(point.triangles),
                        humanBytes(point.bytes),
                        point.mean,
                        point.hausdorff)};
}

// The level of detail the tables are about.
std::optional<CurvePoint> measuredPoint(const RunOutcome& outcome) {
    if (!outcome.distance)
        return std::nullopt;
    return CurvePoint{
        outcome.lod->triangles, outcome.bytes, outcome.distance->hausdorff, outcome.distance->mean};
}

std::string figureOf(const Comparison& comparison, const ChartPlan& plan) {
    Chart chart;
    chart.title = plan.title;
    chart.summary = plan.summary;
    chart.x = plan.x;
    chart.y = plan.y;
    for (std::size_t i = 0; i < comparison.rows.size(); ++i) {
        const ComparisonRow& row = comparison.rows[i];
        if (row.failed())
            continue;
        ChartSeries series;
        series.name = row.outcome.name;
        series.style = rowStyle(row);
        series.number = i;
        for (const CurvePoint& point : row.curve)
            series.points.push_back(chartPoint(plan, point));
        if (const auto measured = measuredPoint(row.outcome))
            series.emphasised = chartPoint(plan, *measured);
        chart.series.push_back(std::move(series));
    }
    if (plan.original_line)
        chart.reference =
            ChartReference{static_cast<double>(comparison.original.outcome.bytes),
                           "Original, " + humanBytes(comparison.original.outcome.bytes)};
    const std::string svg = svgChart(chart);
    if (svg.empty())
        return {};
    return fmt::format(
        "<figure class=\"chart-card\"><figcaption><h3>{}</h3></figcaption>\n{}</figure>\n",
        plan.title,
        svg);
}

std::string legend(const Comparison& comparison) {
    std::string text = "<ul class=\"legend\">\n";
    for (std::size_t i = 0; i < comparison.rows.size(); ++i)
        if (!comparison.rows[i].failed())
            text += fmt::format("<li class=\"lane\" data-series=\"{}\" style=\"{}\">{}{}</li>\n",
                                i,
                                rowStyle(comparison.rows[i]),
                                svgMarker(i),
                                rowName(comparison.rows[i]));
    return text + "</ul>\n";
}

} // namespace

std::string chartsSection(const Comparison& comparison) {
    const ChartAxis triangles{"triangles", ChartUnit::Count};
    const ChartAxis bytes{"file size", ChartUnit::Bytes};
    const ChartAxis percent{"% of the diagonal", ChartUnit::Percent};
    const std::vector<ChartPlan> plans = {{"File size over triangles",
                                           "Lower is better; the dashed line is the original file.",
                                           triangles,
                                           bytes,
                                           trianglesOf,
                                           bytesOf,
                                           true},
                                          {"Mean distance over triangles",
                                           "Lower is better.",
                                           triangles,
                                           percent,
                                           trianglesOf,
                                           meanOf,
                                           false},
                                          {"Mean distance over file size",
                                           "Lower and further left is better: what a byte buys.",
                                           bytes,
                                           percent,
                                           bytesOf,
                                           meanOf,
                                           false},
                                          {"Hausdorff distance over triangles",
                                           "Lower is better.",
                                           triangles,
                                           percent,
                                           trianglesOf,
                                           hausdorffOf,
                                           false}};
    std::string figures;
    for (const ChartPlan& plan : plans)
        figures += figureOf(comparison, plan);
    if (figures.empty())
        return {};
    return "<section aria-labelledby=\"charts\">\n<h2 id=\"charts\">Over the whole range</h2>\n"
           "<p class=\"quiet\">Both axes are logarithmic. Ringed: the level of detail of the "
           "tables above. Levels with no measurable distance are left out where a distance is "
           "drawn.</p>\n" +
           legend(comparison) + "<div class=\"charts\">\n" + figures + "</div>\n</section>\n";
}

} // namespace lodestone
