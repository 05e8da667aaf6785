#include "app/lod_position.h"

namespace lodestone {

std::uint64_t finestWithin(const LodSource& source, double triangle_count) {
    const auto most = static_cast<std::uint64_t>(triangle_count);
    std::uint64_t low = 0;
    std::uint64_t high = source.positionCount() - 1;
    while (low < high) {
        const std::uint64_t middle = low + (high - low) / 2;
        if (source.trianglesAt(middle) <= most)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

} // namespace lodestone
