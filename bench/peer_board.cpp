#include "bench/peer_board.h"

#include "bench/table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/core.h>

namespace lodestone::bench {

namespace {

constexpr double kBetterBelow = 0.99; // of ours: what is nearer is a draw

// Both sides equal to nothing are a draw.
double ratioOf(double theirs, double ours) {
    return theirs == ours ? 1.0 : theirs / ours;
}

struct Measure {
    const char* name;
    double (*ratio)(const PeerRow&); // theirs over ours; not finite: not measured
};

constexpr std::array kMeasures{
    Measure{"CPU time", [](const PeerRow& row) { return row.time_ratio; }},
    Measure{"file",
            [](const PeerRow& row) {
                return ratioOf(static_cast<double>(row.theirs.bytes),
                               static_cast<double>(row.ours.bytes));
            }},
    Measure{"maximum distance",
            [](const PeerRow& row) { return ratioOf(row.theirs.maximum, row.ours.maximum); }},
    Measure{"mean distance",
            [](const PeerRow& row) { return ratioOf(row.theirs.mean, row.ours.mean); }},
    Measure{"image difference",
            [](const PeerRow& row) { return ratioOf(row.theirs.flip, row.ours.flip); }}};

std::string ratioText(double ratio) {
    if (std::isnan(ratio))
        return "–";
    if (ratio > 1000.0)
        return "> 1000×";
    const std::string text = fmt::format("{:.3g}×", ratio);
    return ratio < kBetterBelow ? "**" + text + "**" : text;
}

std::string bytesText(const Worth& worth) {
    return worth.bytes == 0 ? "–" : countText(worth.bytes);
}

std::string flipText(double flip) {
    return std::isfinite(flip) ? fmt::format("{:.4f}", flip) : "–";
}

// Time, and that over ours. Another order of ours comes from the same sequences.
std::string timeCells(const PeerRow& row) {
    if (row.kind == PeerKind::Ours)
        return "the same sequences | 1";
    return secondsText(row.seconds) + " | " + ratioText(kMeasures[0].ratio(row));
}

// The row of ours that all others are compared with.
std::string ownLine(const PeerSheet& sheet) {
    std::string time = secondsText(sheet.our_seconds);
    if (sheet.our_program_seconds.median > 0.0)
        time += "; process " + secondsText(sheet.our_program_seconds);
    return fmt::format("| {} | {} | 1 | {} | {} | {} | 1 | {:.4f} | 1 | {:.4f} | 1 | {} | 1 |\n",
                       sheet.ours_name,
                       time,
                       countText(sheet.ours.triangles),
                       countText(sheet.ours.instances),
                       bytesText(sheet.ours),
                       sheet.ours.maximum,
                       sheet.ours.mean,
                       flipText(sheet.ours.flip));
}

std::string peerLine(const PeerRow& row) {
    const std::string name = row.name + (row.kind == PeerKind::Program ? " (process)" : "");
    if (!row.failure.empty())
        return fmt::format("| {} | failed: {} | | | | | | | | | | | |\n", name, row.failure);
    return fmt::format("| {} | {} | {} | {} | {} | {} | {:.4f} | {} | {:.4f} | {} | {} | {} |\n",
                       name,
                       timeCells(row),
                       countText(row.theirs.triangles),
                       countText(row.theirs.instances),
                       bytesText(row.theirs),
                       ratioText(kMeasures[1].ratio(row)),
                       row.theirs.maximum,
                       ratioText(kMeasures[2].ratio(row)),
                       row.theirs.mean,
                       ratioText(kMeasures[3].ratio(row)),
                       flipText(row.theirs.flip),
                       ratioText(kMeasures[4].ratio(row)));
}

std::string ourLine(const PeerRow& row) {
    const bool as_predicted = row.ours.predicted_bytes == row.ours.bytes;
    return fmt::format("| {} | {} | {} | {} | {}{} | {:.4f} | {:.4f} | {} |\n",
                       row.name,
                       countText(row.ours.triangles),
                       countText(row.ours.instances),
                       countText(row.ours.predicted_bytes),
                       countText(row.ours.bytes),
                       as_predicted ? "" : " **not as predicted**",
                       row.ours.maximum,
                       row.ours.mean,
                       flipText(row.ours.flip));
}

// One peer's ratios of one measure over the inputs.
struct Record {
    std::vector<double> ratios;
    std::string wins; // "Maple 0.83×, Village 0.9×"
    int won = 0;
};

struct PeerRecord {
    std::string name;
    std::array<Record, kMeasures.size()> records;
};

void note(PeerRecord& record, const std::string& input, const PeerRow& row) {
    for (std::size_t m = 0; m < kMeasures.size(); ++m) {
        const double ratio = kMeasures[m].ratio(row);
        if (!std::isfinite(ratio))
            continue;
        Record& of_measure = record.records[m];
        of_measure.ratios.push_back(ratio);
        if (ratio >= kBetterBelow)
            continue;
        ++of_measure.won;
        of_measure.wins +=
            fmt::format("{}{} {:.2g}×", of_measure.wins.empty() ? "" : ", ", input, ratio);
    }
}

std::vector<PeerRecord> recordsOf(std::span<const PeerSheet> sheets) {
    std::vector<PeerRecord> records;
    for (const PeerSheet& sheet : sheets)
        for (const PeerRow& row : sheet.rows) {
            if (row.kind == PeerKind::Ours || !row.failure.empty())
                continue;
            auto record = std::ranges::find(records, row.name, &PeerRecord::name);
            if (record == records.end())
                record = records.insert(records.end(), PeerRecord{row.name, {}});
            note(*record, sheet.input, row);
        }
    return records;
}

std::string predictedLine(std::span<const PeerSheet> sheets) {
    int files = 0;
    int predicted = 0;
    for (const PeerSheet& sheet : sheets) {
        files += sheet.files_of_ours;
        predicted += sheet.files_as_predicted;
    }
    return fmt::format("Predicted = written bytes in {} of {} files of ours.\n", predicted, files);
}

std::string csvWorth(const Worth& worth) {
    return fmt::format("{},{},{},{:.6g},{:.6g},{:.6g}",
                       worth.triangles,
                       worth.instances,
                       worth.bytes,
                       worth.maximum,
                       worth.mean,
                       worth.flip);
}

const char* kindName(PeerKind kind) {
    switch (kind) {
    case PeerKind::Call:
        return "call";
    case PeerKind::Program:
        return "process";
    case PeerKind::Ours:
        return "ours";
    }
    return "";
}

} // namespace

std::string PeerBoard::table(const PeerSheet& sheet) {
    std::string text =
        fmt::format("{} triangles, {} of them unique, {} instances; to {:.0f} %. Predicted = "
                    "written bytes in {} of {} files of ours.\n\n",
                    countText(sheet.triangles),
                    countText(sheet.unique_triangles),
                    countText(sheet.instances),
                    100.0 * kPeerRatio,
                    sheet.files_as_predicted,
                    sheet.files_of_ours);
    text += "| what | CPU time | × ours | triangles | instances | bytes | × ours | max % | × ours "
            "| mean % | × ours | FLIP | × ours |\n"
            "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
    text += ownLine(sheet);
    for (const PeerRow& row : sheet.rows)
        text += peerLine(row);
    text += "\nOurs at as many triangles:\n\n"
            "| beside | triangles | instances | bytes predicted | bytes written | max % | mean % | "
            "FLIP |\n|---|---|---|---|---|---|---|---|\n";
    for (const PeerRow& row : sheet.rows)
        if (row.failure.empty())
            text += ourLine(row);
    if (!sheet.picture_failure.empty())
        text += "\nNo pictures: " + sheet.picture_failure + "\n";
    return text;
}

std::string PeerBoard::tables() const {
    std::string text;
    for (const PeerSheet& sheet : sheets_)
        text += "\n### " + sheet.input + "\n\n" + table(sheet);
    return text;
}

std::string PeerBoard::summary() const {
    const std::vector<PeerRecord> records = recordsOf(sheets_);
    std::string text = predictedLine(sheets_);
    text += "\nEach peer over ours, median over the inputs (in brackets: inputs on which the peer "
            "is better, of those measured):\n\n| peer |";
    for (const Measure& measure : kMeasures)
        text += fmt::format(" {} |", measure.name);
    text += "\n|---|---|---|---|---|---|\n";
    for (const PeerRecord& record : records) {
        text += "| " + record.name + " |";
        for (const Record& of_measure : record.records)
            text += of_measure.ratios.empty()
                        ? " – |"
                        : fmt::format(" {} ({} of {}) |",
                                      ratioText(spreadOf(of_measure.ratios).median),
                                      of_measure.won,
                                      of_measure.ratios.size());
        text += '\n';
    }
    const auto writes_wrong_scales = [](const PeerRecord& record) {
        return record.name.starts_with("gltfpack 0.18") &&
               record.name.find(" -mi") != std::string::npos;
    };
    if (std::ranges::any_of(records, writes_wrong_scales))
        text +=
            "\ngltfpack 0.18 -mi takes the scales of an instance along the wrong axes where it is "
            "rotated and not evenly scaled, as the chair's slanted legs are (mended in its "
            "later versions): those distances are of its file, not of its simplification.\n";
    text += "\nWhere a peer beats us:\n\n";
    for (const PeerRecord& record : records)
        for (std::size_t m = 0; m < kMeasures.size(); ++m)
            if (record.records[m].won > 0)
                text += fmt::format(
                    "- {}, {}: {}\n", record.name, kMeasures[m].name, record.records[m].wins);
    return text;
}

std::string PeerBoard::csv() const {
    std::string text = "input,what,kind,seconds_median,seconds_min,seconds_max,time_over_ours,"
                       "triangles,instances,bytes,max_percent,mean_percent,flip,"
                       "our_triangles,our_instances,our_bytes,our_max_percent,our_mean_percent,"
                       "our_flip,our_predicted_bytes,failure\n";
    for (const PeerSheet& sheet : sheets_)
        for (const PeerRow& row : sheet.rows)
            text += fmt::format("\"{}\",\"{}\",{},{:.6g},{:.6g},{:.6g},{:.6g},{},{},{},\"{}\"\n",
                                sheet.input,
                                row.name,
                                kindName(row.kind),
                                row.seconds.median,
                                row.seconds.min,
                                row.seconds.max,
                                row.time_ratio,
                                csvWorth(row.theirs),
                                csvWorth(row.ours),
                                row.ours.predicted_bytes,
                                row.failure);
    return text;
}

} // namespace lodestone::bench
