#include "app/lane.h"
#include "app/report/html_frame.h"
#include "app/report/html_sections.h"
#include "app/report/html_text.h"
#include "app/report/machine.h"
#include "app/report/svg_chart.h"
#include "bench/machine.h"
#include "bench/study/study_report.h"
#include "bench/table.h"
#include "simplify/algorithm.h"

#include <algorithm>
#include <array>
#include <fmt/core.h>
#include <functional>

namespace lodestone::bench {

namespace {

std::string bytesText(std::uint64_t bytes) {
    return compactCount(static_cast<double>(bytes)) + "B";
}

std::string shareText(double percent) {
    return fixedText(percent, 1) + " %";
}

// What Azim et al. 2015, Table 1, has of a scene.
struct PaperRow {
    const char* name;
    const char* seconds; // Quadric : IAS
    const char* time_ratio;
    const char* bytes; // at 20 %, Quadric : IAS
    const char* size_ratio;
};

constexpr std::array kPaperRows{
    PaperRow{"bunny", "0.39 s : 1.89 s", "0.2 : 1", "235 KB : 235 KB", "1 : 1"},
    PaperRow{"chair", "40 ms : 43 ms", "0.9 : 1", "32 KB : 31 KB", "1 : 1"},
    PaperRow{"maple", "13 s : 5 s", "2.6 : 1", "17 MB : 110 KB", "154 : 1"},
    PaperRow{"village", "30 s : 17 s", "1.8 : 1", "31 MB : 6 MB", "5 : 1"}};

std::string cells(std::initializer_list<std::string> texts) {
    std::string row;
    for (const std::string& text : texts)
        row += fmt::format("<td>{}</td>", escaped(text));
    return row;
}

std::string ratioText(std::uint64_t larger, std::uint64_t smaller) {
    const double ratio =
        static_cast<double>(larger) / static_cast<double>(std::max<std::uint64_t>(smaller, 1));
    return fixedText(ratio, ratio < 10.0 ? 2 : 1) + " : 1";
}

std::string tableRow(const TableRow& row) {
    const auto paper = std::ranges::find(kPaperRows, row.name, &PaperRow::name);
    std::string text = fmt::format("<tr><th>{}</th>", escaped(row.name));
    text += cells({countText(row.counts.submeshes),
                   countText(row.counts.instances),
                   fixedText(static_cast<double>(row.counts.instances) /
                                 static_cast<double>(row.counts.submeshes),
                             2),
                   countText(row.counts.triangles),
                   bytesText(row.original_bytes),
                   lodestone::secondsText(row.quadric_seconds) + " : " +
                       lodestone::secondsText(row.ias_seconds),
                   fixedText(row.time_ratio, 1) + " : 1",
                   bytesText(row.quadric.bytes) + " : " + bytesText(row.by_cost.bytes),
                   ratioText(row.quadric.bytes, row.by_cost.bytes),
                   bytesText(row.ias.bytes)});
    if (paper != kPaperRows.end())
        text += cells({paper->seconds, paper->time_ratio, paper->bytes, paper->size_ratio});
    return text + "</tr>\n";
}

std::string tableSection(const Study& study) {
    std::string text =
        "<section aria-labelledby=\"table\">\n<h2 id=\"table\">Four scenes at 20 % of their "
        "triangles</h2>\n<p class=\"quiet\">Quadric : IAS in the paper’s order (by cost). Seconds "
        "of CPU on one thread for all levels of detail; the paper’s are for one level, on its own "
        "machine and its own models of these counts.</p>\n<div class=\"scroll\"><table><thead>"
        "<tr><th>scene</th><th>submeshes</th><th>instances</th><th>IPS</th><th>triangles</th>"
        "<th>original</th><th>time</th><th>ratio</th><th>size</th><th>ratio</th><th>IAS by "
        "triangle</th><th>paper: time</th><th>ratio</th><th>size</th><th>ratio</th></tr></thead>"
        "\n<tbody>\n";
    for (const TableRow& row : study.table)
        text += tableRow(row);
    return text + "</tbody></table></div>\n</section>\n";
}

// Colours of the lanes of the same names.
std::string styleOf(std::size_t number) {
    constexpr std::array kLanes{"quadric", "ias", "wild"};
    return laneStyle(findAlgorithm(kLanes[number % kLanes.size()]));
}

std::string figure(const Chart& chart) {
    std::string keys;
    for (const ChartSeries& series : chart.series)
        keys += fmt::format("<li class=\"lane\" style=\"{}\">{}{}</li>\n",
                            series.style,
                            svgMarker(series.number),
                            escaped(series.name));
    return fmt::format("<figure class=\"chart-card\"><figcaption><h3>{}</h3><p class=\"quiet\">{}"
                       "</p></figcaption>\n<ul class=\"legend\">{}</ul>{}</figure>\n",
                       escaped(chart.title),
                       escaped(chart.summary),
                       keys,
                       svgChart(chart));
}

std::string treeFigure(const Study& study) {
    Chart chart;
    chart.title = "File size of the maple tree over its triangles";
    chart.summary = "As the paper’s figure 5. The dashed line is the original file.";
    chart.x = {"triangles", ChartUnit::Count};
    chart.y = {"file size", ChartUnit::Bytes};
    for (const SizeCurve& curve : study.tree_curves) {
        ChartSeries series;
        series.name = curve.name;
        series.number = chart.series.size();
        series.style = styleOf(series.number);
        for (const StudyLevel& level : curve.levels)
            series.points.push_back({static_cast<double>(level.triangles),
                                     static_cast<double>(level.bytes),
                                     fmt::format("{} triangles\n{}",
                                                 countText(level.triangles),
                                                 bytesText(level.bytes))});
        chart.series.push_back(std::move(series));
    }
    chart.reference = ChartReference{static_cast<double>(study.tree_bytes),
                                     "Original, " + bytesText(study.tree_bytes)};
    return figure(chart);
}

// Share of models (%) over a value, as a line from the least to the largest.
ChartSeries distribution(std::string name, std::vector<double> values, std::size_t number) {
    ChartSeries series;
    series.name = std::move(name);
    series.number = number;
    series.style = styleOf(number);
    series.marks = ChartMarks::None;
    std::ranges::sort(values);
    for (std::size_t i = 0; i < values.size(); ++i)
        series.points.push_back(
            {values[i],
             100.0 * static_cast<double>(i + 1) / static_cast<double>(values.size()),
             {}});
    return series;
}

std::vector<double> valuesOf(const Study& study,
                             const std::function<double(const StudyRow&)>& value) {
    std::vector<double> values;
    for (const StudyRow& row : study.rows)
        if (row.failure.empty())
            values.push_back(value(row));
    return values;
}

struct Curve {
    const char* name;
    std::function<double(const StudyRow&)> value;
};

// Shares of the models below, of one or two values. x: what and in which unit.
std::string sharesFigure(const Study& study,
                         Chart chart,
                         const ChartAxis& x,
                         const std::vector<Curve>& curves) {
    chart.x = x;
    chart.y = {"models", ChartUnit::Percent, ChartScale::Linear};
    for (const Curve& curve : curves)
        chart.series.push_back(
            distribution(curve.name, valuesOf(study, curve.value), chart.series.size()));
    return figure(chart);
}

std::string ipsFigure(const Study& study) {
    Chart chart;
    chart.title = "Instances per submesh";
    chart.summary = "Share of models below; as the paper’s figure 6.";
    return sharesFigure(
        study, chart, {"instances per submesh", ChartUnit::Count}, {{"models", &StudyRow::ips}});
}

std::string sizeFigure(const Study& study) {
    Chart chart;
    chart.title = "File size IAS saves against Quadric";
    chart.summary = "At equal triangles, 20 % of the original’s; negative: larger. Share of models "
                    "below; as the paper’s figure 7.";
    return sharesFigure(study,
                        chart,
                        {"% of Quadric’s file", ChartUnit::Percent, ChartScale::Linear},
                        {{"ordering cost", &StudyRow::costSizeReductionPercent},
                         {"ordering triangle", &StudyRow::sizeReductionPercent}});
}

std::string errorFigure(const Study& study) {
    static constexpr double kMost = 2.0; // % of the diagonal; the rest is off the chart
    Chart chart;
    chart.title = "Distance IAS adds to Quadric’s";
    chart.summary = "Difference of the distances from the original at equal triangles, within 2 % "
                    "of the diagonal either way; negative: IAS is closer. Share of models below.";
    const auto added = [](double StudyLevel::*distance) {
        return [distance](const StudyRow& row) {
            return std::clamp(row.ias.*distance - row.quadric.*distance, -kMost, kMost);
        };
    };
    return sharesFigure(
        study,
        chart,
        {"% of the diagonal", ChartUnit::Percent, ChartScale::Linear},
        {{"Hausdorff", added(&StudyLevel::hausdorff)}, {"mean", added(&StudyLevel::mean)}});
}

std::string card(std::string_view title, const std::string& value, std::string_view rest) {
    return fmt::format(
        "<li><p>{}</p><p class=\"figure\">{}</p><small>{}</small></li>\n", title, value, rest);
}

std::string cards(const StudySummary& summary) {
    return "<ul class=\"highlights\">\n" +
           card("Models",
                countText(summary.models),
                fmt::format("{} to {} triangles",
                            countText(summary.least_triangles),
                            countText(summary.most_triangles))) +
           card("File size saved",
                shareText(summary.mean_size_reduction),
                fmt::format("on average; by cost {}; the paper: 57 %",
                            shareText(summary.mean_cost_size_reduction))) +
           card("IAS larger",
                shareText(summary.larger_share),
                fmt::format("of models; by cost {}; the paper: 1 %",
                            shareText(summary.cost_larger_share))) +
           card("Hausdorff kept",
                shareText(summary.hausdorff_kept_share),
                "of models within 1.05 × Quadric’s + 0.02 %; the paper: 98 %") +
           card("Mean distance no worse", shareText(summary.mean_no_worse_share), "of models") +
           "</ul>\n";
}

std::string modelRow(const StudyRow& row) {
    std::string text =
        fmt::format("<tr><th>{}<small>{}</small></th>", escaped(row.name), escaped(row.kind));
    if (!row.failure.empty())
        return text + fmt::format("<td class=\"failure\" colspan=\"9\">{}</td></tr>\n",
                                  escaped(row.failure));
    return text +
           cells({fixedText(row.ips(), 2),
                  countText(row.counts.triangles),
                  countText(row.ias.triangles),
                  bytesText(row.original_bytes),
                  bytesText(row.quadric.bytes),
                  bytesText(row.ias.bytes),
                  fixedText(row.sizeReductionPercent(), 1),
                  fixedText(row.quadric.hausdorff, 3),
                  fixedText(row.ias.hausdorff, 3)}) +
           "</tr>\n";
}

// Those with the largest and those with the least saving; all are in the CSV.
std::string modelsSection(const Study& study) {
    constexpr std::size_t kEnd = 20;
    std::vector<const StudyRow*> rows;
    for (const StudyRow& row : study.rows)
        if (row.failure.empty())
            rows.push_back(&row);
    std::ranges::sort(rows, [](const StudyRow* a, const StudyRow* b) {
        return a->sizeReductionPercent() < b->sizeReductionPercent();
    });
    if (rows.size() > 2 * kEnd)
        rows.erase(rows.begin() + kEnd, rows.end() - kEnd);
    std::string text =
        "<section aria-labelledby=\"models\">\n<h2 id=\"models\">Models that gain least, and "
        "most</h2>\n<div class=\"scroll\"><table><thead><tr><th>model</th><th>IPS</th>"
        "<th>triangles</th><th>left</th><th>original</th><th>Quadric</th><th>IAS</th><th>saved %"
        "</th><th>Hausdorff: Quadric</th><th>IAS</th></tr></thead>\n<tbody>\n";
    for (const StudyRow* row : rows)
        text += modelRow(*row);
    return text + "</tbody></table></div>\n</section>\n";
}

std::string failuresSection(const Study& study) {
    std::string items;
    for (const StudyRow& row : study.rows)
        if (!row.failure.empty())
            items +=
                fmt::format("<dt>{}</dt><dd>{}</dd>\n", escaped(row.name), escaped(row.failure));
    return items.empty() ? std::string()
                         : "<section aria-labelledby=\"left-out\">\n<h2 id=\"left-out\">Left out"
                           "</h2>\n<dl class=\"notes\">\n" +
                               items + "</dl>\n</section>\n";
}

} // namespace

std::string studyPage(const Study& study) {
    constexpr const char* kTitle = "Instance-aware simplification, measured again";
    const PageFrame frame{thisMachine().program,
                          kTitle,
                          "study",
                          kTitle,
                          "IAS against Quadric on the expanded scene, at equal triangles",
                          commitText()};
    return framedPage(frame,
                      cards(summaryOf(study)) + tableSection(study) +
                          "<section aria-labelledby=\"figures\">\n<h2 id=\"figures\">Figures"
                          "</h2>\n<div class=\"charts\">\n" +
                          treeFigure(study) + ipsFigure(study) + sizeFigure(study) +
                          errorFigure(study) + "</div>\n</section>\n" + modelsSection(study) +
                          failuresSection(study));
}

} // namespace lodestone::bench
