#pragma once
// Levels of detail of textured models as pictures: ours beside meshoptimizer's attribute-aware
// simplifier, at the same number of triangles.
#include "bench/figures.h"
#include "bench/peers/peer.h"
#include "simplify/algorithm.h"

#include <filesystem>

namespace lodestone::bench {

struct AttributeBench {
    std::vector<MeshPeer> peers;  // that heed attributes
    ParameterValues parameters;   // of ours; those that an algorithm has not are left out
    std::filesystem::path sheets; // folder for contact sheets; empty: none
    std::uint32_t picture_px = 256;
};

// One level of detail beside a peer's.
struct AttributeRow {
    std::string model;
    double ratio = 0.0; // asked of the peer
    std::size_t peer = 0;
    std::uint64_t their_triangles = 0;
    std::uint64_t our_triangles = 0; // at most theirs
    double their_flip = 0.0;         // mean over 8 views of the lit model, 0..1
    double our_flip = 0.0;
};

struct AttributeTable {
    std::vector<AttributeRow> rows;
    std::string markdown;
};

// Every textured model in the folder whose name passes, at 50, 20 and 5 % of each mesh's triangles.
// Main thread (it draws). What fails is told on stderr and left out. Returns the exit code.
int addAttributeTable(AttributeTable& table,
                      const AttributeBench& bench,
                      const std::filesystem::path& models,
                      const TitleFilter& wanted);

} // namespace lodestone::bench
