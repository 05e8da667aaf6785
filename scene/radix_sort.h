#pragma once
#include <array>
#include <cstdint>
#include <vector>

namespace lodestone {

// Sorts by the upper 32 bits, stable. O(n), three passes over 11 bits.
inline void sortByUpperHalf(std::vector<std::uint64_t>& values) {
    constexpr std::array<int, 3> kShift{32, 43, 54};
    constexpr std::size_t kBuckets = 2048;
    std::vector<std::uint64_t> other(values.size());
    for (const int shift : kShift) {
        std::array<std::size_t, kBuckets> at{};
        for (const std::uint64_t value : values)
            ++at[(value >> shift) & (kBuckets - 1)];
        std::size_t begin = 0;
        for (std::size_t& count : at) {
            const std::size_t size = count;
            count = begin;
            begin += size;
        }
        for (const std::uint64_t value : values)
            other[at[(value >> shift) & (kBuckets - 1)]++] = value;
        values.swap(other);
    }
}

} // namespace lodestone
