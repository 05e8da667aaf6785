#pragma once
// The sheets of all inputs as text: who is better in what.
#include "bench/peer_sheet.h"

namespace lodestone::bench {

class PeerBoard {
public:
    void add(PeerSheet sheet) { sheets_.push_back(std::move(sheet)); }

    bool empty() const { return sheets_.empty(); }

    // Markdown: each peer over all inputs, and where it beats us.
    std::string summary() const;
    // Markdown: every sheet under its heading.
    std::string tables() const;
    // Markdown: the peers, and beside them ours at as many triangles.
    static std::string table(const PeerSheet& sheet);
    // One line a row, with a header; plain numbers.
    std::string csv() const;

private:
    std::vector<PeerSheet> sheets_;
};

} // namespace lodestone::bench
