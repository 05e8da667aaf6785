#include "app/cli_report.h"
#include "app/report/html_sections.h"
#include "app/report/html_text.h"

#include <algorithm>
#include <fmt/core.h>

namespace lodestone {

namespace {

std::string figureOf(const Comparison& comparison, const ComparisonRow& row, std::size_t index) {
    const RunOutcome& outcome = row.outcome;
    const std::string share = percentText(100.0 * shareOf(comparison, row));
    return fmt::format(
        R"(<figure class="lane" style="{0}">
<figcaption>{1}<span class="quiet">{2}</span></figcaption>
<a href="#stage" data-pick="{3}"><img id="picture-{3}" data-name="{4}" src="data:image/png;base64,{5}" width="1200" height="900" alt="{6} drawn with {4}: {7} triangles"/></a>
<p class="numbers"><span><strong>{7}</strong> tri <span class="quiet">{8}</span></span><strong>{9}</strong></p>
</figure>
)",
        rowStyle(row),
        rowSwatch(row),
        row.image ? fmt::format("FLIP {:.4f}", row.image->flip) : std::string(),
        index,
        rowName(row),
        base64(row.picture_png),
        escaped(comparison.model.name),
        thousands(outcome.lod->triangles),
        share,
        humanBytes(outcome.bytes));
}

// What the stage shows on its left (A) or right (B).
std::string choices(const std::vector<const ComparisonRow*>& rows, char side, std::size_t chosen) {
    std::string text =
        fmt::format("<fieldset><legend>{} <span class=\"quiet\">{}</span></legend>\n",
                    side,
                    side == 'A' ? "left" : "right");
    for (std::size_t i = 0; i < rows.size(); ++i)
        text += fmt::format(
            "<label><input type=\"radio\" name=\"side-{0}\" value=\"{1}\"{2}/>{3}</label>\n",
            side,
            i,
            i == chosen ? " checked=\"checked\"" : "",
            rowSwatch(*rows[i]));
    return text + "</fieldset>\n";
}

// Of the shown algorithms: whose picture is closest. The original where there is none.
std::size_t closestPicture(const Comparison& comparison,
                           const std::vector<const ComparisonRow*>& shown) {
    std::size_t closest = 0;
    for (const ComparisonRow* row : competingRows(comparison)) {
        const auto at = static_cast<std::size_t>(std::ranges::find(shown, row) - shown.begin());
        if (at < shown.size() && row->image &&
            (closest == 0 || row->image->flip < shown[closest]->image->flip))
            closest = at;
    }
    return closest;
}

std::string stage(const Comparison& comparison, const std::vector<const ComparisonRow*>& rows) {
    return fmt::format(
        R"(<div id="stage" class="stage" hidden="hidden">
<div class="view" id="view" tabindex="0" role="group" aria-label="Two pictures over each other. Left and right arrow move the divider, space swaps the pictures, plus and minus zoom, zero shows all.">
<img id="side-a" alt=""/><div class="over" id="over"><img id="side-b" alt=""/></div>
<div class="divider" id="divider"></div>
<span class="tag left" id="tag-a"></span><span class="tag right" id="tag-b"></span>
</div>
<div class="controls">
<div class="segments" role="group" aria-label="How the two are compared">
<button type="button" data-mode="wipe" aria-pressed="true">Wipe</button><button type="button" data-mode="flicker" aria-pressed="false">Flicker</button>
</div>
{}{}<div class="segments" role="group" aria-label="Zoom">
<button type="button" id="closer" aria-label="Zoom in">+</button><button type="button" id="farther" aria-label="Zoom out">−</button><button type="button" id="whole">Fit</button>
</div>
<p class="quiet hint">Drag the divider; double-click to zoom, then drag. <kbd>←</kbd> <kbd>→</kbd> <kbd>Space</kbd> <kbd>+</kbd> <kbd>−</kbd></p>
</div>
</div>
)",
        choices(rows, 'A', 0),
        choices(rows, 'B', closestPicture(comparison, rows)));
}

} // namespace

std::string picturesSection(const Comparison& comparison) {
    std::string text =
        "<section aria-labelledby=\"pictures\">\n<h2 id=\"pictures\">Pictures</h2>\n";
    const std::vector<const ComparisonRow*> rows = shownRows(comparison);
    const bool drawn = !comparison.original.picture_png.empty();
    if (!drawn)
        return text +
               fmt::format("<p class=\"missing\">There are no pictures: {}.</p>\n</section>\n",
                           escaped(comparison.pictures_missing));
    text += stage(comparison, rows) + "<div class=\"pictures\">\n";
    for (std::size_t i = 0; i < rows.size(); ++i)
        text += figureOf(comparison, *rows[i], i);
    return text + "</div>\n</section>\n";
}

} // namespace lodestone
