#pragma once
// The promised figures and the scenes beside peers, as the bench goes through them.
#include "bench/peer_board.h"
#include "bench/rows.h"

#include <functional>

namespace lodestone::bench {

using TitleFilter = std::function<bool(const std::string& title)>;

// Adds every wanted section of promised figures to the table. given: folder of further scenes,
// empty: none. What fails is told on stderr and left out. Returns the exit code.
int addFigures(Bench& bench, const std::string& given, const TitleFilter& wanted);

enum class PeerInputs : std::uint8_t { Few, All };

// Adds a sheet for every wanted input that is there, and the names of those that are not.
// As addFigures otherwise.
struct PeerRun {
    PeerBoard board;
    std::vector<std::string> tables; // Markdown, one an input
    std::vector<std::string> absent; // inputs
};

int addPeers(PeerRun& run,
             const PeerBench& bench,
             Inputs& inputs,
             PeerInputs which,
             const TitleFilter& wanted);

} // namespace lodestone::bench
