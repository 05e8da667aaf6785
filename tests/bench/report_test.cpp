// RESULTS.md as it is put together.
#include "bench/report.h"
#include "bench/sheet_json.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace lodestone::bench {

namespace {

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

PeerSheet sheet() {
    PeerSheet sheet;
    sheet.input = "Maple";
    sheet.triangles = 1'818'074;
    sheet.ours_name = "Lodestone IAS";
    sheet.our_seconds = {1.0, 0.5, 2.0};
    sheet.ours = {100, 3, 1000, 1000, 0.5, 0.25, 0.125};
    PeerRow row;
    row.name = "Peer";
    row.kind = PeerKind::Program;
    row.seconds = {3.0, 2.0, 4.0};
    row.time_ratio = 3.0;
    row.theirs = {99, 3, 900, 0, 0.5, 0.25, std::numeric_limits<double>::quiet_NaN()};
    row.ours = {98, 3, 990, 990, 0.5, 0.25, 0.125};
    sheet.rows.push_back(row);
    return sheet;
}

} // namespace

TEST(SheetJson, ComesBackAsItWas) {
    const PeerSheet back = sheetOf(nlohmann::json::parse(sheetJson(sheet()).dump()));
    EXPECT_EQ(PeerBoard::table(back), PeerBoard::table(sheet()));
    EXPECT_TRUE(std::isnan(back.rows.at(0).theirs.flip));
}

TEST(Report, SumsTheFiguresOfAllSections) {
    Report report;
    report.figures = {{"A", "rows of A", 3, {}}, {"B", "rows of B", 1, {"B: too slow"}}};
    const std::string text = markdown(report);
    EXPECT_TRUE(contains(text, "4 of 5 targets met"));
    EXPECT_TRUE(contains(text, "- missed: B: too slow"));
    EXPECT_LT(text.find("rows of A"), text.find("rows of B"));
}

TEST(Report, SaysWhatIsNotThere) {
    Report report;
    report.open = {"peers: Village"};
    report.failed = {"peers: Duck: no memory"};
    report.absent = {"VTK: install libvtk9-dev"};
    const std::string text = markdown(report);
    EXPECT_TRUE(contains(text, "Still to come:\n\n- peers: Village"));
    EXPECT_TRUE(contains(text, "- failed: peers: Duck: no memory"));
    EXPECT_TRUE(contains(text, "- not measured: VTK"));
}

TEST(Report, ShowsPredictedAndWrittenBytesOfEveryRow) {
    PeerSheet made = sheet();
    EXPECT_TRUE(contains(PeerBoard::table(made), "| Peer | 98 | 3 | 990 | 990 |"));
    made.rows[0].ours.predicted_bytes = 991;
    EXPECT_TRUE(contains(PeerBoard::table(made), "| 991 | 990 **not as predicted** |"));
}

} // namespace lodestone::bench
