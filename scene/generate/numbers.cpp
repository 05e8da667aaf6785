#include "scene/generate/numbers.h"

#include <algorithm>
#include <cmath>

namespace lodestone::generate {

std::uint64_t Random::bits() {
    state_ += 0x9E3779B97F4A7C15ull;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return z ^ (z >> 31);
}

double Random::unit() {
    return static_cast<double>(bits() >> 11) * 0x1p-53;
}

double sine(double angle) {
    // Fold into [-pi/2, pi/2], then Taylor to x^15 (next term below 7e-12).
    double x = angle - 2.0 * kPi * std::floor(angle / (2.0 * kPi) + 0.5);
    if (x > kPi / 2.0)
        x = kPi - x;
    else if (x < -kPi / 2.0)
        x = -kPi - x;
    const double x2 = x * x;
    double sum = 1.0;
    for (int k = 15; k >= 3; k -= 2)
        sum = 1.0 - sum * x2 / static_cast<double>(k * (k - 1));
    return x * sum;
}

double cosine(double angle) {
    return sine(angle + kPi / 2.0);
}

double smoothStep(double from, double to, double x) {
    const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

namespace {

double latticeValue(int x, int y, int z, std::uint32_t seed) {
    std::uint32_t h = static_cast<std::uint32_t>(x) * 0x8DA6B343u +
                      static_cast<std::uint32_t>(y) * 0xD8163841u +
                      static_cast<std::uint32_t>(z) * 0xCB1AB31Fu + seed * 0x9E3779B9u;
    h = (h ^ (h >> 15)) * 0x2C1B3C6Du;
    h = (h ^ (h >> 12)) * 0x297A2D39u;
    h ^= h >> 15;
    return static_cast<double>(h) / 2147483647.5 - 1.0;
}

} // namespace

double noise(const glm::dvec3& p, std::uint32_t seed) {
    const glm::dvec3 cell(std::floor(p.x), std::floor(p.y), std::floor(p.z));
    const glm::dvec3 f = p - cell;
    const glm::dvec3 w = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    const int x = static_cast<int>(cell.x);
    const int y = static_cast<int>(cell.y);
    const int z = static_cast<int>(cell.z);
    const auto lerp_x = [&](int dy, int dz) {
        const double a = latticeValue(x, y + dy, z + dz, seed);
        return a + (latticeValue(x + 1, y + dy, z + dz, seed) - a) * w.x;
    };
    const double front = lerp_x(0, 0) + (lerp_x(1, 0) - lerp_x(0, 0)) * w.y;
    const double back = lerp_x(0, 1) + (lerp_x(1, 1) - lerp_x(0, 1)) * w.y;
    return front + (back - front) * w.z;
}

double fractalNoise(glm::dvec3 p, std::uint32_t seed, int octaves) {
    double sum = 0.0;
    double strength = 0.5;
    for (int octave = 0; octave < octaves; ++octave) {
        sum += strength * noise(p, seed + static_cast<std::uint32_t>(octave));
        strength *= 0.5;
        p = p * 2.03 + glm::dvec3(17.3, 5.1, 11.7);
    }
    return sum * 1.4;
}

} // namespace lodestone::generate
