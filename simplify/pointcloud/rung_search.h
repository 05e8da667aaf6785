#pragma once
// Where along a ladder of tries a falling measure meets a limit, in few tries.
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace lodestone {

struct RungSearch {
    std::uint64_t last = 0; // rungs 0..last
    // Rungs that are known, or worth trying first; rising.
    std::vector<std::uint64_t> first;
    // How far below zero is near enough to stop at; 0: the very rung.
    double tolerance = 0.0;
    // Above 0 where a rung is still too fine, else at or past the limit; finite, falling but for
    // noise, straight in the rung as far as possible. Called for several rungs at once, from
    // several threads: the same values in any order.
    std::function<double(std::uint64_t)> excess;
};

// Where the excess turns.
struct RungBracket {
    // Still above 0, the next rung not (or, within the tolerance, some farther one); 0 also where
    // rung 0 is past the limit already.
    std::uint64_t fine = 0;
    // Of those tried that are not above 0, the nearest to it: that next rung, but for noise.
    // last + 1: there is none.
    std::uint64_t coarse = 0;
};

// Tries two rungs at once, on both sides of where a straight line between the nearest known ones
// would meet zero, every third time at thirds. Which are tried depends on the search alone.
// About log2(last) rounds at worst, three or four where the excess is smooth.
RungBracket searchRungs(const RungSearch& search);

} // namespace lodestone
