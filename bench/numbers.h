#pragma once
// Repeatable numbers for made inputs.
#include <cstdint>
#include <glm/glm.hpp>

namespace lodestone::bench {

// xorshift64.
class Random {
public:
    double between(double low, double high) {
        state_ ^= state_ << 13U;
        state_ ^= state_ >> 7U;
        state_ ^= state_ << 17U;
        return low + (high - low) * static_cast<double>(state_ >> 11U) / 9007199254740992.0;
    }

private:
    std::uint64_t state_ = 0x9E3779B97F4A7C15U;
};

// Value noise, -1..1, summed over octaves of half the amplitude and 2.03 times the frequency.
double fractalNoise(glm::dvec3 point, int octaves);

} // namespace lodestone::bench
