#include "simplify/collapse/removal_order.h"

#include "simplify/collapse/removal.h"
#include "simplify/collapse/removal_grid.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace lodestone {

namespace {

// The lowest bits in reverse order.
std::size_t reversedBits(std::uint32_t value, int bits) {
    value = (value >> 1 & 0x55555555u) | (value & 0x55555555u) << 1;
    value = (value >> 2 & 0x33333333u) | (value & 0x33333333u) << 2;
    value = (value >> 4 & 0x0F0F0F0Fu) | (value & 0x0F0F0F0Fu) << 4;
    return bits == 0 ? 0 : std::size_t{__builtin_bswap32(value)} >> (32 - bits);
}

// The strata of a round go in bit-reversed order. alive: of about one size, along the Morton curve.
std::vector<std::uint32_t> thinned(std::span<const Member> members,
                                   std::vector<std::uint32_t> alive) {
    std::vector<std::uint32_t> order;
    double growth = 1.0;
    for (int round = 0; alive.size() > 1; ++round) {
        growth = std::min(kMaxGrowth, growth * std::sqrt(2.0));
        const std::size_t pairs = alive.size() / 2;
        const int bits = static_cast<int>(std::bit_width(pairs - 1));
        std::vector<std::uint32_t> survivors(alive.begin() + static_cast<std::ptrdiff_t>(2 * pairs),
                                             alive.end());
        std::vector<std::uint32_t> stay(pairs);
        for (std::uint32_t slot = 0; slot < 1u << bits; ++slot) {
            const std::size_t pair = reversedBits(slot, bits);
            if (pair >= pairs)
                continue;
            const std::uint32_t a = alive[2 * pair];
            const std::uint32_t b = alive[2 * pair + 1];
            const bool a_fits = members[a].room >= growth;
            const bool b_fits = members[b].room >= growth;
            const bool keep_a =
                a_fits != b_fits ? a_fits : ((pair + static_cast<std::size_t>(round)) & 1) == 0;
            stay[pair] = keep_a ? a : b;
            order.push_back(keep_a ? b : a);
        }
        survivors.insert(survivors.begin(), stay.begin(), stay.end());
        alive = std::move(survivors);
    }
    order.insert(order.end(), alive.begin(), alive.end());
    return order;
}

// Members of about one size each, the largest first; none empty.
std::vector<std::vector<std::uint32_t>> sizesOf(std::span<const Member> members) {
    constexpr std::size_t kMostSizes = 12;
    const double largest = std::ranges::max_element(members, {}, &Member::area)->area;
    const double least = std::ranges::min_element(members, {}, &Member::area)->area;
    const bool alike = !differInSize(least, largest);
    std::vector<std::vector<std::uint32_t>> sizes(kMostSizes);
    for (std::uint32_t m = 0; m < members.size(); ++m) {
        std::size_t size = 0;
        double area = largest / kSizeFactor;
        while (!alike && size + 1 < kMostSizes && members[m].area < area) {
            area /= kSizeFactor;
            ++size;
        }
        sizes[size].push_back(m);
    }
    std::erase_if(sizes, [](const auto& size) { return size.empty(); });
    return sizes;
}

// What each removal of one size costs while only its own size counts, rising.
std::vector<double> costsOf(std::span<const Member> members,
                            std::span<const std::uint32_t> order,
                            const Bounds& spots) {
    std::vector<glm::dvec3> places; // the longest-lived first
    for (std::size_t i = order.size(); i-- > 0;)
        places.push_back(members[order[i]].at);
    const std::vector<double> distances = distancesToEarlier(places, spots);
    std::vector<double> costs(order.size());
    for (std::size_t i = 0; i < costs.size(); ++i) {
        const double distance = std::min(distances[costs.size() - 1 - i], spots.diagonal());
        costs[i] = members[order[i]].area * distance * distance;
    }
    for (std::size_t i = 1; i < costs.size(); ++i)
        costs[i] = std::max(costs[i], costs[i - 1]);
    return costs;
}

} // namespace

std::vector<std::uint32_t> removalOrder(std::span<const Member> members, const Bounds& spots) {
    std::vector<std::vector<std::uint32_t>> sizes = sizesOf(members);
    for (std::vector<std::uint32_t>& size : sizes)
        size = thinned(members, std::move(size));
    if (sizes.size() == 1)
        return std::move(sizes.front());
    std::vector<std::pair<double, std::uint32_t>> merged; // cost, member
    for (std::size_t size = sizes.size(); size-- > 0;) {
        const std::vector<double> costs = costsOf(members, sizes[size], spots);
        for (std::size_t i = 0; i < costs.size(); ++i)
            merged.emplace_back(costs[i], sizes[size][i]);
    }
    std::ranges::stable_sort(merged, {}, &std::pair<double, std::uint32_t>::first);
    std::vector<std::uint32_t> order;
    order.reserve(merged.size());
    for (const auto& [cost, member] : merged)
        order.push_back(member);
    return order;
}

} // namespace lodestone
