#include "app/report/html_page.h"

#include "app/cli_report.h"
#include "app/report/comparison_text.h"
#include "app/report/html_frame.h"
#include "app/report/html_sections.h"
#include "app/report/html_text.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>
#include <functional>

namespace lodestone {

namespace {

std::string fact(std::string_view name, std::string_view value) {
    return fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", name, escaped(value));
}

std::string factsList(const Comparison& comparison) {
    const ModelFacts& model = comparison.model;
    std::string text = "<dl class=\"facts\">\n";
    text += fact("Triangles", thousands(model.counts.triangles));
    text += fact("Unique triangles", thousands(model.counts.unique_triangles));
    text += fact("Submeshes", thousands(model.counts.submeshes));
    text += fact("Instances", thousands(model.counts.instances));
    text += fact("Materials", thousands(model.materials));
    text += fact("Images", thousands(model.images));
    if (model.file_bytes > 0)
        text += fact("Source file", humanBytes(model.file_bytes));
    text += fact("Diagonal", fmt::format("{:.4g}", model.diagonal));
    return text + "</dl>\n";
}

using Measure = std::function<std::optional<double>(const ComparisonRow&)>;

struct Highlight {
    std::string_view title;
    Measure measure; // less is better
    std::function<std::string(double)> text;
};

// Those whose value looks the same as the best one share the card.
std::string highlightCard(const Comparison& comparison, const Highlight& highlight) {
    std::optional<double> least;
    const std::vector<const ComparisonRow*> rows = competingRows(comparison);
    for (const ComparisonRow* row : rows)
        if (const std::optional<double> value = highlight.measure(*row))
            least = std::min(*value, least.value_or(*value));
    if (!least)
        return {};
    const std::string figure = highlight.text(*least);
    std::string names;
    for (const ComparisonRow* row : rows)
        if (const std::optional<double> value = highlight.measure(*row))
            names += highlight.text(*value) == figure ? rowSwatch(*row) : std::string();
    return fmt::format(
        "<li><p>{}</p><p class=\"figure\">{}</p>{}</li>\n", highlight.title, figure, names);
}

// Who is best at what.
std::string highlightsList(const Comparison& comparison) {
    if (comparison.rows.size() < 2)
        return {};
    const auto percent = [](double value) {
        return fixedText(value, decimalsFor(value)) + " <small>% of the diagonal</small>";
    };
    const std::vector<Highlight> highlights = {
        {"Smallest file",
         [](const ComparisonRow& row) { return static_cast<double>(row.outcome.bytes); },
         [](double value) { return humanBytes(static_cast<std::uint64_t>(value)); }},
        {"Smallest mean distance",
         [](const ComparisonRow& row) {
             const auto& distance = row.outcome.distance;
             return distance ? std::optional(distance->mean) : std::nullopt;
         },
         percent},
        {"Closest picture",
         [](const ComparisonRow& row) {
             return row.image ? std::optional(row.image->flip) : std::nullopt;
         },
         [](double value) { return fmt::format("{:.4f} <small>FLIP</small>", value); }},
        {"Fastest to build",
         [](const ComparisonRow& row) {
             const StageSeconds& seconds = row.outcome.seconds;
             return seconds.sequence + seconds.schedule + seconds.readout;
         },
         secondsText}};
    std::string cards;
    for (const Highlight& highlight : highlights)
        cards += highlightCard(comparison, highlight);
    return "<ul class=\"highlights\">\n" + cards + "</ul>\n";
}

std::string noteItems(const Comparison& comparison, const ComparisonRow& row) {
    std::string items;
    const std::string deviation = deviationText(comparison, row);
    if (row.failed())
        items += fmt::format("<li class=\"warning\">Failed: {}</li>\n", escaped(row.failure));
    if (!deviation.empty())
        items += fmt::format("<li>{}</li>\n", escaped(deviation));
    for (const std::string& note : row.outcome.notes)
        items += fmt::format("<li>{}</li>\n", escaped(note));
    return items.empty()
               ? std::string()
               : fmt::format("<dt>{}</dt><dd><ul>\n{}</ul></dd>\n", rowSwatch(row), items);
}

std::string notesSection(const Comparison& comparison) {
    std::string text;
    std::string model;
    for (const std::string& note : comparison.model.notes)
        model += fmt::format("<li>{}</li>\n", escaped(note));
    if (!model.empty())
        text += fmt::format("<dt>The file</dt><dd><ul>\n{}</ul></dd>\n", model);
    text += noteItems(comparison, comparison.original);
    for (const ComparisonRow& row : comparison.rows)
        text += noteItems(comparison, row);
    if (text.empty())
        return {};
    return "<section aria-labelledby=\"notes\">\n<h2 id=\"notes\">Notes</h2>\n<dl "
           "class=\"notes\">\n" +
           text + "</dl>\n</section>\n";
}

std::string algorithmList(const Comparison& comparison) {
    std::string text;
    for (const ComparisonRow& row : comparison.rows)
        text += fmt::format("<li>{} <span class=\"quiet\">{}. {}</span> {}</li>\n",
                            rowSwatch(row),
                            escaped(row.algorithm->name),
                            escaped(row.algorithm->paper),
                            escaped(row.algorithm->summary));
    return "<ul class=\"algorithms\">\n" + text + "</ul>\n";
}

std::string methodSection(const Comparison& comparison) {
    return fmt::format(
        R"(<section aria-labelledby="method">
<h2 id="method">How this was measured</h2>
{}<ul class="method">
<li><strong>Bytes</strong>: of a GLB file that was written for every row. “Predicted” is the size told before writing; the two must be equal to the byte.</li>
<li><strong>Distance</strong>: between the surfaces, both ways, at points spread evenly by area; in % of the diagonal of the scene’s bounding box. Hausdorff is the largest distance found, mean the average. Instances count each time they are drawn.</li>
<li><strong>Picture</strong>: mean over twelve cameras around the scene, against the original; background does not count. FLIP: 0 equal, 1 as different as can be. SSIM: 1 equal. PSNR in decibels, higher is closer.</li>
<li><strong>Time</strong>: wall clock on this machine, everything else as the algorithm’s defaults are.</li>
</ul>
</section>
)",
        algorithmList(comparison));
}

std::string machineText(const MachineFacts& machine) {
    return fmt::format("{} · {} · {} threads · {} · {}",
                       machine.program,
                       machine.processor,
                       machine.threads,
                       machine.system,
                       machine.date);
}

} // namespace

std::string comparisonPage(const Comparison& comparison) {
    const PageFrame frame{comparison.machine.program,
                          comparison.model.name + " – comparison of levels of detail",
                          "comparison",
                          comparison.model.name,
                          "Every algorithm at <strong>" + escaped(targetText(comparison.target)) +
                              "</strong>",
                          machineText(comparison.machine)};
    return framedPage(frame,
                      factsList(comparison) + highlightsList(comparison) +
                          picturesSection(comparison) + tablesSection(comparison) +
                          chartsSection(comparison) + notesSection(comparison) +
                          methodSection(comparison));
}

} // namespace lodestone
