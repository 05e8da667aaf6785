#pragma once
// The promised figures and the scenes beside peers, as the bench goes through them.
#include "bench/peer_sheet.h"
#include "bench/rows.h"

#include <functional>

namespace lodestone::bench {

using TitleFilter = std::function<bool(const std::string& title)>;

// Rows of promised figures under one heading.
struct FigureSection {
    std::string title;
    std::function<Result<void>(Bench&)> add; // to the bench's table
};

// All of them. given: folder of further scenes, empty: none.
std::vector<FigureSection> figureSections(const std::string& given);

// A scene on which peers are measured beside us.
struct PeerSection {
    std::string title;
    bool quick = false; // also in a quick run
    // None where the input is absent.
    std::function<Result<std::optional<PeerSheet>>(const PeerBench&, Inputs&)> measure;
};

// Single meshes, then instanced scenes, then textured ones.
std::vector<PeerSection> peerSections();

} // namespace lodestone::bench
