#include "app/report/byte_parts.h"
#include "app/report/comparison_text.h"
#include "app/report/html_page.h"
#include "app/report/html_text.h"
#include "app/report/png.h"
#include "app/report/svg_chart.h"
#include "scene/generate.h"
#include "tests/app/fake_algorithm.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <nlohmann/json.hpp>
#include <stb_image.h>
#include <unistd.h>

namespace lodestone {

namespace {

// A row with invented numbers: `kept` of the chair's 2,240 triangles.
ComparisonRow rowOf(const ScenePtr& scene, const Algorithm* algorithm, std::uint64_t kept) {
    ComparisonRow row;
    row.algorithm = algorithm;
    row.outcome.algorithm = algorithm ? algorithm->id : "original";
    row.outcome.name = algorithm ? algorithm->short_name : "Original";
    row.outcome.scene = scene;
    Lod lod = fullLod(*scene);
    lod.triangles = kept;
    row.outcome.lod = std::make_shared<const Lod>(std::move(lod));
    row.outcome.bytes = 10 * kept;
    row.outcome.predicted_bytes = row.outcome.bytes;
    row.parts = {6 * kept, kept, kept, kept, kept};
    if (algorithm) {
        row.outcome.distance = Distance{0.5, 0.02, 0.03, 0.5, 0.02, 0.4, 0.02, 1000};
        row.image = ImageDifference{0.04, 0.95, std::numeric_limits<double>::infinity(), 12};
        row.curve = {{2240, 22400, 0.0, 0.0}, {1120, 11200, 0.1, 0.01}, {224, 2240, 0.9, 0.09}};
    }
    return row;
}

Comparison comparisonOf(std::uint64_t kept) {
    const ScenePtr scene = generateScene("chair").value();
    Comparison comparison;
    comparison.model.name = "chair & <table>.glb";
    comparison.model.counts = countScene(*scene);
    comparison.target = {Target::Kind::Ratio, 0.5};
    comparison.original = rowOf(scene, nullptr, 2240);
    comparison.rows.push_back(rowOf(scene, &fixtures::fakeAlgorithm(), kept));
    comparison.pictures_missing = "no GL";
    return comparison;
}

std::vector<std::string> linesOf(const std::string& text) {
    return [&] {
        std::vector<std::string> lines;
        std::istringstream stream(text);
        for (std::string line; std::getline(stream, line);)
            lines.push_back(line);
        return lines;
    }();
}

std::size_t countOf(const std::string& text, std::string_view what) {
    std::size_t count = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1))
        ++count;
    return count;
}

} // namespace

TEST(ByteParts, AddUpToTheFileAndKnowTheJsonOfNodesAndMaterials) {
    const ScenePtr scene = generateScene("chair").value();
    const std::filesystem::path file = std::filesystem::temp_directory_path() /
                                       ("lodestone_parts_" + std::to_string(getpid()) + ".glb");
    const Lod lod = fullLod(*scene);
    const auto bytes = [&](Instancing instancing) {
        ExportOptions options;
        options.instancing = instancing;
        EXPECT_TRUE(exportScene(*scene, lod, file, options).has_value());
        const ByteParts parts = splitGlbFile(file).value();
        EXPECT_EQ(parts.total(), std::filesystem::file_size(file));
        return parts;
    };
    const ByteParts rows = bytes(Instancing::Gpu);
    const ByteParts nodes = bytes(Instancing::Nodes);
    std::filesystem::remove(file);
    std::uint64_t geometry = 0; // positions, normals; 16-bit indices
    for (const Submesh& submesh : scene->submeshes)
        for (const Primitive& primitive : submesh.primitives) {
            const Geometry& one = *primitive.geometry;
            geometry += one.positions.size() * 12 + one.indices.size() * 2;
            for (const Attribute& attribute : one.attributes)
                geometry += attribute.bytes.size();
        }
    EXPECT_EQ(rows.geometry, geometry);
    EXPECT_EQ(nodes.geometry, geometry);
    EXPECT_GT(nodes.instances, rows.instances);
    EXPECT_GT(rows.materials, 0u);
    EXPECT_EQ(rows.materials, nodes.materials);
}

TEST(ByteParts, WhatIsNoGlbIsRefused) {
    const std::string cut = "glTF" + std::string(20, '\xFF');
    for (const std::string& text : {std::string(), std::string("not a GLB file at all"), cut}) {
        const auto parts = splitGlb(std::as_bytes(std::span(text)), "broken.glb");
        ASSERT_FALSE(parts.has_value());
        EXPECT_EQ(parts.error().kind, ErrorKind::BadInput);
        EXPECT_NE(parts.error().message.find("broken.glb"), std::string::npos);
    }
    EXPECT_FALSE(splitGlbFile("no such file").has_value());
}

TEST(HtmlText, MarkupAndBrokenUtf8AreMadeHarmless) {
    EXPECT_EQ(escaped("<a href=\"x\">&'"), "&lt;a href=&quot;x&quot;&gt;&amp;&#39;");
    EXPECT_EQ(escaped("Ahornbäume 木"), "Ahornbäume 木");
    const std::string replaced = "\xEF\xBF\xBD";
    EXPECT_EQ(escaped("a\xFFz"), "a" + replaced + "z");                 // no lead byte
    EXPECT_EQ(escaped("\xC0\xAF"), replaced + replaced);                // overlong
    EXPECT_EQ(escaped("\xED\xA0\x80"), replaced + replaced + replaced); // surrogate
    EXPECT_EQ(escaped("\xE6\x9C"), replaced + replaced);                // cut off
    EXPECT_EQ(escaped(std::string_view("\0\x1B", 2)), replaced + replaced);
}

TEST(HtmlText, Base64IsPadded) {
    EXPECT_EQ(base64(""), "");
    EXPECT_EQ(base64("f"), "Zg==");
    EXPECT_EQ(base64("fo"), "Zm8=");
    EXPECT_EQ(base64("foo"), "Zm9v");
    EXPECT_EQ(base64("\xFF\xFE\xFD"), "//79");
}

TEST(HtmlText, NumbersShowAsManyDigitsAsCount) {
    EXPECT_EQ(secondsText(12.34), "12.3 s");
    EXPECT_EQ(secondsText(1.0), "1.00 s");
    EXPECT_EQ(secondsText(0.0384), "38 ms");
    EXPECT_EQ(secondsText(0.0004), "0.4 ms");
    EXPECT_EQ(decimalsFor(0.0), 0);
    EXPECT_EQ(decimalsFor(0.0123), 3);
    EXPECT_EQ(decimalsFor(1.5), 1);
    EXPECT_EQ(decimalsFor(150.0), 0);
    EXPECT_EQ(compactCount(20'000), "20 K");
    EXPECT_EQ(percentText(20.0), "20 %");
    EXPECT_EQ(percentText(0.516), "0.52 %");
}

TEST(Png, HoldsThePixels) {
    Picture picture{3, 2, {}};
    for (std::uint8_t i = 0; i < 24; ++i)
        picture.rgba.push_back(static_cast<std::uint8_t>(10 * i));
    const std::string png = encodePng(picture).value();
    int width = 0;
    int height = 0;
    int channels = 0;
    stbi_uc* const read = stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(png.data()),
                                                static_cast<int>(png.size()),
                                                &width,
                                                &height,
                                                &channels,
                                                3);
    ASSERT_NE(read, nullptr);
    EXPECT_EQ(width, 3);
    EXPECT_EQ(height, 2);
    for (std::size_t pixel = 0; pixel < 6; ++pixel)
        for (std::size_t channel = 0; channel < 3; ++channel)
            EXPECT_EQ(read[3 * pixel + channel], picture.rgba[4 * pixel + channel]);
    stbi_image_free(read);
    EXPECT_FALSE(encodePng(Picture{}).has_value());
}

TEST(SvgChart, LeavesOutWhatNoLogarithmReaches) {
    Chart chart;
    chart.title = "Size & error";
    ChartSeries series;
    series.name = "one";
    const double nan = std::numeric_limits<double>::quiet_NaN();
    series.points = {
        {1.0, 0.0, {}}, {0.0, 1.0, {}}, {-1.0, 1.0, {}}, {nan, 1.0, {}}, {1.0, nan, {}}};
    chart.series = {series};
    EXPECT_EQ(svgChart(chart), "");
    chart.series[0].points.push_back({5.0, 7.0, "five & seven"});
    const std::string one = svgChart(chart);
    EXPECT_EQ(countOf(one, "class=\"marker\""), 1u);
    EXPECT_NE(one.find("five &amp; seven"), std::string::npos);
    EXPECT_NE(one.find("Size &amp; error"), std::string::npos);
    EXPECT_EQ(one.find("nan"), std::string::npos);
    EXPECT_EQ(one.find("inf"), std::string::npos);
}

TEST(SvgChart, LargerIsFurtherRightAndFurtherUp) {
    Chart chart;
    chart.series.resize(1);
    chart.series[0].points = {{10.0, 1.0, {}}, {1000.0, 50.0, {}}};
    chart.reference = ChartReference{100.0, "limit"};
    const std::string svg = svgChart(chart);
    double x[2] = {};
    double y[2] = {};
    const std::size_t line = svg.find("class=\"line\" d=\"M");
    ASSERT_NE(line, std::string::npos);
    ASSERT_EQ(
        std::sscanf(svg.c_str() + line, "class=\"line\" d=\"M%lf %lfL%lf %lf", x, y, x + 1, y + 1),
        4);
    EXPECT_LT(x[0], x[1]);
    EXPECT_GT(y[0], y[1]);
    double reference = 0.0;
    ASSERT_EQ(std::sscanf(svg.c_str() + svg.find("class=\"reference\""),
                          "class=\"reference\" d=\"M%*f %lf",
                          &reference),
              1);
    EXPECT_LT(reference, y[1]);
}

TEST(SvgChart, EveryRangeHasSomeTicksAndNotTooMany) {
    for (const double factor : {1.05, 1.3, 3.0, 40.0, 1e4, 1e7}) {
        Chart chart;
        chart.series.resize(1);
        chart.series[0].points = {{3.2, 3.2, {}}, {3.2 * factor, 3.2 * factor, {}}};
        const std::size_t ticks = countOf(svgChart(chart), "class=\"tick\"");
        EXPECT_GE(ticks, 4u) << factor; // of both axes
        EXPECT_LE(ticks, 16u) << factor;
    }
}

TEST(SvgChart, NothingHasNoSign) {
    Chart chart;
    chart.x = {"saved", ChartUnit::Percent, ChartScale::Linear};
    chart.y = {"share", ChartUnit::Percent, ChartScale::Linear};
    chart.series.resize(1);
    chart.series[0].points = {{-3.0, 0.5, {}}, {97.0, 99.5, {}}};
    const std::string svg = svgChart(chart);
    EXPECT_NE(svg.find(">0 %<"), std::string::npos);
    EXPECT_EQ(svg.find("-0 %"), std::string::npos);
}

TEST(ComparisonText, ColumnsOfTheTableAreAligned) {
    const std::vector<std::string> lines = linesOf(comparisonTable(comparisonOf(1120)));
    ASSERT_GE(lines.size(), 3u);
    EXPECT_EQ(lines[0].size(), lines[1].size());
    EXPECT_EQ(lines[0].size(), lines[2].size());
    EXPECT_TRUE(lines[1].starts_with("original"));
    EXPECT_TRUE(lines[2].starts_with("fake"));
}

TEST(ComparisonText, CsvQuotesWhatNeedsIt) {
    Comparison comparison = comparisonOf(1120);
    comparison.rows[0].outcome.notes = {"one, two", "a \"third\""};
    const std::vector<std::string> lines = linesOf(comparisonCsv(comparison));
    ASSERT_EQ(lines.size(), 3u);
    EXPECT_EQ(std::ranges::count(lines[0], ','), std::ranges::count(lines[1], ','));
    EXPECT_TRUE(lines[2].starts_with("fake,1120,")) << lines[2];
    EXPECT_TRUE(lines[2].ends_with(",true,\"one, two; a \"\"third\"\"\"")) << lines[2];
}

TEST(ComparisonText, EqualPicturesHaveNoPsnrInJsonAndCsv) {
    const Comparison comparison = comparisonOf(1120);
    const auto json = nlohmann::json::parse(comparisonJson(comparison));
    EXPECT_TRUE(json["rows"][0]["image"]["psnr_db"].is_null());
    EXPECT_EQ(json["rows"][0]["bytes_by_part"]["geometry"], 6 * 1120);
    EXPECT_EQ(comparisonCsv(comparison).find("inf"), std::string::npos);
}

TEST(ComparisonText, DeviationsFromTheTargetAreToldBeyondOnePercent) {
    EXPECT_EQ(deviationText(comparisonOf(1120), comparisonOf(1120).rows[0]), "");
    const Comparison below = comparisonOf(840);
    EXPECT_EQ(deviationText(below, below.rows[0]), "25 % below the target");
    const Comparison above = comparisonOf(1176);
    EXPECT_EQ(deviationText(above, above.rows[0]), "the target is missed: 5.0 % above");
}

TEST(ComparisonText, AFailedRowStandsInEveryForm) {
    Comparison comparison = comparisonOf(1120);
    ComparisonRow failed;
    failed.algorithm = &fixtures::fakeAlgorithm();
    failed.failure = "the mesh <is> empty";
    comparison.rows.push_back(std::move(failed));
    EXPECT_NE(comparisonTable(comparison).find("failed: fake: the mesh <is> empty"),
              std::string::npos);
    EXPECT_EQ(linesOf(comparisonCsv(comparison)).size(), 4u);
    const auto json = nlohmann::json::parse(comparisonJson(comparison));
    EXPECT_EQ(json["rows"][1]["failure"], "the mesh <is> empty");
    const std::string page = comparisonPage(comparison);
    EXPECT_NE(page.find("the mesh &lt;is&gt; empty"), std::string::npos);
    EXPECT_EQ(countOf(page, "<tr data-algorithm=\"fake\">"), 6u); // two rows in three tables
}

TEST(ComparisonPage, TextOfTheFileCannotBecomeMarkup) {
    Comparison comparison = comparisonOf(1120);
    comparison.model.notes = {"<script>alert(1)</script>"};
    comparison.rows[0].outcome.notes = {"]]> & </style>"};
    const std::string page = comparisonPage(comparison);
    EXPECT_EQ(countOf(page, "<script"), 1u);
    EXPECT_NE(page.find("chair &amp; &lt;table&gt;.glb"), std::string::npos);
    EXPECT_NE(page.find("&lt;script&gt;alert(1)&lt;/script&gt;"), std::string::npos);
    EXPECT_EQ(countOf(page, "]]>"), 2u); // the ends of style and script
}

TEST(ComparisonPage, WhatMissedItsTargetIsBestAtNothing) {
    Comparison comparison = comparisonOf(1120);
    ComparisonRow above = comparison.rows[0];
    above.outcome.target_met = false;
    above.outcome.bytes /= 2;
    comparison.rows.push_back(std::move(above));
    ASSERT_EQ(competingRows(comparison).size(), 1u);
    EXPECT_EQ(competingRows(comparison)[0], &comparison.rows[0]);
    EXPECT_EQ(countOf(comparisonPage(comparison), "class=\"best\""), 0u);
    comparison.rows[0].outcome.target_met = false;
    EXPECT_EQ(competingRows(comparison).size(), 2u);
    EXPECT_GE(countOf(comparisonPage(comparison), "class=\"best\""), 1u);
}

TEST(ComparisonPage, AWrongPredictionIsShownAsOne) {
    Comparison comparison = comparisonOf(1120);
    EXPECT_EQ(countOf(comparisonPage(comparison), "✗"), 0u);
    EXPECT_EQ(countOf(comparisonPage(comparison), "✓"), 2u);
    comparison.rows[0].outcome.predicted_bytes += 1;
    EXPECT_EQ(countOf(comparisonPage(comparison), "✗"), 1u);
    EXPECT_NE(comparisonTable(comparison).find("WRONG"), std::string::npos);
}

} // namespace lodestone
