#include "bench/inputs.h"
#include "bench/numbers.h"
#include "scene/scene_builder.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lodestone::bench {

namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

Submesh submeshOf(std::string name, Geometry geometry) {
    return {std::move(name),
            {{PrimitiveMode::Triangles, std::make_shared<Geometry>(std::move(geometry))}}};
}

// A bumpy, bent, open tube, 7.5 high, of 1,920 triangles.
Geometry trunk(Random& random) {
    constexpr std::uint32_t kSides = 24;
    constexpr std::uint32_t kRings = 40;
    constexpr double kHeight = 7.5;
    constexpr double kFootRadius = 0.35;
    const double offset = random.between(0.0, 99.0);
    Geometry tube;
    for (std::uint32_t ring = 0; ring <= kRings; ++ring)
        for (std::uint32_t side = 0; side < kSides; ++side) {
            const double t = static_cast<double>(ring) / kRings;
            const double angle = kTurn * side / kSides;
            const glm::dvec2 out(std::cos(angle), std::sin(angle));
            const double bump = fractalNoise(
                {3.0 * out.x + offset, 3.0 * out.y, 0.3 * t * kHeight / kFootRadius}, 3);
            const double radius = (kFootRadius - 0.25 * t) * (1.0 + 0.25 * bump);
            tube.positions.emplace_back(radius * out.x + 0.2 * std::sin(3.0 * t + offset),
                                        t * kHeight,
                                        radius * out.y + 0.2 * std::sin(2.0 * (t + offset)));
        }
    for (std::uint32_t ring = 0; ring < kRings; ++ring)
        for (std::uint32_t side = 0; side < kSides; ++side) {
            const std::uint32_t a = ring * kSides + side;
            const std::uint32_t b = ring * kSides + (side + 1) % kSides;
            for (const std::uint32_t vertex : {a, a + kSides, b, b, a + kSides, b + kSides})
                tube.indices.push_back(vertex);
        }
    return tube;
}

// An open, curved diamond of four triangles about its middle.
Geometry leaf(Random& random) {
    const double offset = random.between(0.0, 99.0);
    const double curve = random.between(0.05, 0.25);
    Geometry card;
    card.positions.emplace_back(0.0F);
    for (std::uint32_t corner = 0; corner < 4; ++corner) {
        const double angle = kTurn * corner / 4.0;
        const double radius =
            1.0 + 0.35 * std::cos(2.0 * angle) + 0.1 * std::sin(6.0 * angle + offset);
        const double sag =
            0.04 *
            fractalNoise(
                {3.0 * radius * std::cos(angle) + offset, 3.0 * radius * std::sin(angle), 0.0}, 1);
        card.positions.emplace_back(
            radius * std::cos(angle), curve * radius * radius + sag, radius * std::sin(angle));
        for (const std::uint32_t vertex : {0U, 1 + (corner + 1) % 4, 1 + corner})
            card.indices.push_back(vertex);
    }
    return card;
}

// Somewhere in an egg-shaped crown, turned any way.
glm::dmat4 placeInCrown(Random& random) {
    const double angle = random.between(0.0, kTurn);
    const double height = random.between(2.2, 8.1);
    const double rim = 2.9 * std::sqrt(std::max(0.05, 1.0 - std::pow((height - 5.0) / 3.4, 2.0)));
    const double radius = rim * std::sqrt(random.between(0.1, 1.0));
    Trs place;
    place.scale = glm::dvec3(random.between(0.04, 0.1));
    glm::dvec4 turn{};
    for (int i = 0; i < 4; ++i)
        turn[i] = random.between(-1.0, 1.0);
    turn = glm::normalize(turn);
    place.rotation = glm::dquat(turn.w, turn.x, turn.y, turn.z);
    place.translation = {radius * std::cos(angle), height, radius * std::sin(angle)};
    return toMatrix(place);
}

} // namespace

ScenePtr leafCards() {
    constexpr std::uint32_t kLeaves = 40'000;
    constexpr std::uint32_t kKinds = 4;
    Random random;
    SceneBuilder builder("cards");
    builder.addSubmesh(submeshOf("trunk", trunk(random)));
    builder.addNode("trunk", kNone, glm::dmat4(1.0), 0);
    for (std::uint32_t kind = 0; kind < kKinds; ++kind)
        builder.addSubmesh(submeshOf("leaf " + std::to_string(kind), leaf(random)));
    for (std::uint32_t i = 0; i < kLeaves; ++i)
        builder.addNode("leaf", kNone, placeInCrown(random), 1 + i % kKinds);
    return builder.finish();
}

} // namespace lodestone::bench
