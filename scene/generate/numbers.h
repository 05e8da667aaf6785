#pragma once
// Numbers that come out the same on every machine: a random generator, noise, sine and cosine that
// use nothing but exactly rounded operations (+ - * / sqrt floor).
#include <cstdint>
#include <glm/glm.hpp>

namespace lodestone::generate {

constexpr double kPi = 3.14159265358979323846;

// splitmix64 (Steele et al. 2014).
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed) {}

    std::uint64_t bits();
    double unit(); // [0, 1)

    double in(double low, double high) { return low + (high - low) * unit(); }

    double about(double mean, double spread) { return mean + spread * (unit() - unit()); }

    std::uint32_t below(std::uint32_t count) { // [0, count), count > 0
        return static_cast<std::uint32_t>(bits() % count);
    }

private:
    std::uint64_t state_;
};

// angle: radians, any size below 1e6. Error below 1e-9.
double sine(double angle);
double cosine(double angle);

// 0 below `from`, 1 above `to`, smooth between.
double smoothStep(double from, double to, double x);
// Value noise in [-1, 1], feature size 1.
double noise(const glm::dvec3& p, std::uint32_t seed);
// Sum of octaves, each half as strong and twice as fine; in about [-1, 1].
double fractalNoise(glm::dvec3 p, std::uint32_t seed, int octaves);

} // namespace lodestone::generate
