#pragma once
// RESULTS.md, put together from the parts that were measured.
#include "bench/parts.h"
#include "bench/peer_board.h"

namespace lodestone::bench {

// A section of promised figures.
struct FigureSheet {
    std::string title;
    std::string rows; // Markdown
    int met = 0;      // targets
    std::vector<std::string> missed;
};

// A section that is text alone.
struct TextSheet {
    std::string summary; // Markdown, may be empty
    std::string tables;
};

nlohmann::json figureJson(const FigureSheet& sheet);
FigureSheet figureOf(const nlohmann::json& json); // throws as sheetOf
nlohmann::json textJson(const TextSheet& sheet);
TextSheet textOf(const nlohmann::json& json); // throws as sheetOf

struct Report {
    std::string commit;
    std::string machine; // Markdown
    std::string how;     // "5 rounds"
    std::string figures_introduction;
    std::string peers_introduction;
    std::vector<FigureSheet> figures;
    PeerBoard board;
    std::vector<TextSheet> texts;
    std::vector<std::string> absent; // what was not measured, and why
    std::vector<std::string> failed; // what failed, and why
    std::vector<std::string> open;   // parts that this run has still to measure
    double seconds = 0.0;            // wall time of all parts
};

std::string markdown(const Report& report);

} // namespace lodestone::bench
