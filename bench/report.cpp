#include "bench/report.h"

#include <fmt/core.h>

namespace lodestone::bench {

nlohmann::json figureJson(const FigureSheet& sheet) {
    return {
        {"title", sheet.title}, {"rows", sheet.rows}, {"met", sheet.met}, {"missed", sheet.missed}};
}

FigureSheet figureOf(const nlohmann::json& json) {
    return {json.at("title").get<std::string>(),
            json.at("rows").get<std::string>(),
            json.at("met").get<int>(),
            json.at("missed").get<std::vector<std::string>>()};
}

nlohmann::json textJson(const TextSheet& sheet) {
    return {{"summary", sheet.summary}, {"tables", sheet.tables}};
}

TextSheet textOf(const nlohmann::json& json) {
    return {json.at("summary").get<std::string>(), json.at("tables").get<std::string>()};
}

namespace {

std::string list(const std::vector<std::string>& lines, const std::string& start) {
    std::string text;
    for (const std::string& line : lines)
        text += fmt::format("- {}{}\n", start, line);
    return text.empty() ? text : "\n" + text;
}

std::string figuresSummary(const std::vector<FigureSheet>& sheets) {
    int met = 0;
    std::vector<std::string> missed;
    for (const FigureSheet& sheet : sheets) {
        met += sheet.met;
        missed.insert(missed.end(), sheet.missed.begin(), sheet.missed.end());
    }
    return fmt::format("\n### Promised figures\n\n{} of {} targets met.\n{}",
                       met,
                       static_cast<std::size_t>(met) + missed.size(),
                       list(missed, "missed: "));
}

std::string summaryText(const Report& report) {
    std::string text;
    if (!report.open.empty())
        text += "\nNot complete: the run was broken off or goes on. Still to come:\n" +
                list(report.open, "");
    text += list(report.failed, "failed: ");
    if (!report.figures.empty())
        text += figuresSummary(report.figures);
    if (!report.board.empty())
        text += "\n### Peers\n\n" + report.board.summary();
    text += list(report.absent, "not measured: ");
    for (const TextSheet& sheet : report.texts)
        text += sheet.summary;
    return text;
}

} // namespace

std::string markdown(const Report& report) {
    std::string text = fmt::format("# Results\n\n"
                                   "Written by `lodestone_bench` at commit {}; {}, {:.0f} minutes "
                                   "in all.\n\n"
                                   "{}\n## Summary\n{}",
                                   report.commit,
                                   report.how,
                                   report.seconds / 60.0,
                                   report.machine,
                                   summaryText(report));
    if (!report.figures.empty())
        text += report.figures_introduction;
    for (const FigureSheet& sheet : report.figures)
        text += sheet.rows;
    if (!report.board.empty())
        text += report.peers_introduction + report.board.tables();
    for (const TextSheet& sheet : report.texts)
        text += sheet.tables;
    return text;
}

} // namespace lodestone::bench
