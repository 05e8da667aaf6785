#include "simplify/pointcloud/rung_search.h"

#include <algorithm>
#include <array>
#include <optional>
#include <tbb/parallel_invoke.h>

namespace lodestone {

namespace {

struct Tried {
    std::uint64_t rung = 0;
    double excess = 0.0;
};

class Search {
public:
    explicit Search(const RungSearch& search) : search_(search) {}

    RungBracket run() {
        fine_ = {0, search_.excess(0)};
        if (fine_.excess <= 0.0)
            return {};
        for (const std::uint64_t rung : search_.first)
            if (rung > fine_.rung && !coarse_)
                note({std::min(rung, search_.last), search_.excess(rung)});
        for (int round = 1; !isDone(); ++round)
            tryPair(coarse_ ? inside(round) : beyond());
        return {fine_.rung, nearest_ ? nearest_->rung : search_.last + 1};
    }

private:
    using Pair = std::array<std::uint64_t, 2>;

    bool isDone() const {
        if (!coarse_)
            return fine_.rung >= search_.last;
        return coarse_->rung - fine_.rung <= 1 || nearest_->excess >= -search_.tolerance;
    }

    void note(const Tried& tried) {
        if (tried.excess <= 0.0) {
            if (!nearest_ || tried.excess > nearest_->excess ||
                (tried.excess == nearest_->excess && tried.rung < nearest_->rung))
                nearest_ = tried;
            if (!coarse_ || tried.rung < coarse_->rung)
                coarse_ = tried;
        } else if (tried.rung > fine_.rung && (!coarse_ || tried.rung < coarse_->rung)) {
            before_ = fine_;
            fine_ = tried;
        }
    }

    void tryPair(const Pair& pair) {
        Tried low{pair[0], 0.0};
        Tried high{pair[1], 0.0};
        tbb::parallel_invoke([&] { low.excess = search_.excess(low.rung); },
                             [&] {
                                 if (high.rung != low.rung)
                                     high.excess = search_.excess(high.rung);
                             });
        note(low);
        if (high.rung != low.rung)
            note(high);
    }

    // No rung past the limit is known: as far as the last two show, and twice as far.
    Pair beyond() const {
        const double fallen = before_.excess - fine_.excess;
        const auto walked = static_cast<double>(fine_.rung - before_.rung);
        const double largest = static_cast<double>(search_.last) / 8.0;
        const double step =
            fallen > 0.0 ? std::min(largest, fine_.excess / fallen * walked) : largest;
        const auto at = [&](double factor) {
            const auto ahead = static_cast<std::uint64_t>(factor * step);
            return std::min(search_.last, fine_.rung + std::max<std::uint64_t>(1, ahead));
        };
        return {at(1.05), at(2.0)};
    }

    // Around where the line between the bracket's ends comes to the middle of what is near enough.
    Pair inside(int round) const {
        const std::uint64_t width = coarse_->rung - fine_.rung; // >= 2
        const auto at = [&](double offset) {
            const double largest = static_cast<double>(width - 1);
            return fine_.rung + static_cast<std::uint64_t>(std::clamp(offset, 1.0, largest));
        };
        const auto wide = static_cast<double>(width);
        if (round % 3 == 0)
            return {at(wide / 3.0), at(wide * 2.0 / 3.0)};
        const double aim = fine_.excess + 0.5 * search_.tolerance;
        const double meets = wide * aim / (fine_.excess - coarse_->excess);
        const double aside = std::max(0.5, wide / 20.0);
        const std::uint64_t low = at(meets - aside);
        return {low, std::max(at(meets + aside), std::min(low + 1, coarse_->rung - 1))};
    }

    const RungSearch& search_;
    Tried fine_;
    Tried before_; // the last but one on the fine side
    std::optional<Tried> coarse_;
    std::optional<Tried> nearest_; // of all past the limit
};

} // namespace

RungBracket searchRungs(const RungSearch& search) {
    return Search(search).run();
}

} // namespace lodestone
