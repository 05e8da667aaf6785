#include "bench/inputs.h"
#include "bench/numbers.h"
#include "scene/scene_builder.h"

#include <array>
#include <cmath>
#include <numbers>

namespace lodestone::bench {

namespace {

double latticeValue(const glm::ivec3& cell) {
    std::uint32_t hash = static_cast<std::uint32_t>(cell.x) * 374761393U +
                         static_cast<std::uint32_t>(cell.y) * 668265263U +
                         static_cast<std::uint32_t>(cell.z) * 2147483647U;
    hash = (hash ^ (hash >> 13U)) * 1274126177U;
    return ((hash ^ (hash >> 16U)) & 0xFFFFFFU) / 8388608.0 - 1.0;
}

double valueNoise(const glm::dvec3& point) {
    const glm::dvec3 floor = glm::floor(point);
    const glm::ivec3 cell(floor);
    const glm::dvec3 t = point - floor;
    const glm::dvec3 weight = t * t * (3.0 - 2.0 * t);
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::ivec3 offset(corner % 2, corner / 2 % 2, corner / 4);
        const glm::dvec3 side = glm::mix(1.0 - weight, weight, glm::dvec3(offset));
        sum += latticeValue(cell + offset) * side.x * side.y * side.z;
    }
    return sum;
}

// Vertices of a cube's surface on an integer grid, shared between the faces.
class CubeGrid {
public:
    CubeGrid(std::uint32_t side, double noise_offset)
        : side_(side), noise_offset_(noise_offset),
          ids_(std::size_t{6} * (side + 1) * (side + 1), kNone) {}

    std::uint32_t vertex(std::uint32_t face, std::uint32_t u, std::uint32_t v) {
        std::uint32_t& id = ids_[(std::size_t{face} * (side_ + 1) + u) * (side_ + 1) + v];
        if (id != kNone)
            return id;
        std::array<std::uint32_t, 3> cell{};
        const std::uint32_t axis = face / 2;
        cell[axis] = face % 2 == 1 ? side_ : 0;
        cell[(axis + 1) % 3] = u;
        cell[(axis + 2) % 3] = v;
        if (u != 0 && v != 0 && u != side_ && v != side_)
            return id = add(cell);
        const auto [found, is_new] = on_edges_.try_emplace(cell, kNone);
        if (is_new)
            found->second = add(cell);
        return id = found->second;
    }

    std::vector<glm::vec3> takePositions() { return std::move(positions_); }

private:
    std::uint32_t add(const std::array<std::uint32_t, 3>& cell) {
        glm::dvec3 direction{};
        for (int axis = 0; axis < 3; ++axis)
            direction[axis] = std::tan((2.0 * cell[static_cast<std::size_t>(axis)] / side_ - 1.0) *
                                       std::numbers::pi / 4.0);
        direction = glm::normalize(direction);
        const double bump = fractalNoise(direction * 2.2 + glm::dvec3(noise_offset_, 0.0, 0.0), 6);
        positions_.emplace_back(direction * (1.0 + 0.12 * bump));
        return static_cast<std::uint32_t>(positions_.size() - 1);
    }

    std::uint32_t side_;
    double noise_offset_;
    std::vector<std::uint32_t> ids_; // [6 * (side + 1)^2]
    std::map<std::array<std::uint32_t, 3>, std::uint32_t> on_edges_;
    std::vector<glm::vec3> positions_;
};

} // namespace

double fractalNoise(glm::dvec3 point, int octaves) {
    double amplitude = 1.0;
    double sum = 0.0;
    for (int octave = 0; octave < octaves; ++octave) {
        sum += amplitude * valueNoise(point);
        point *= 2.03;
        amplitude *= 0.5;
    }
    return sum;
}

ScenePtr displacedSphere(std::uint32_t side) {
    CubeGrid grid(side, Random().between(0.0, 99.0));
    auto geometry = std::make_shared<Geometry>();
    for (std::uint32_t face = 0; face < 6; ++face)
        for (std::uint32_t u = 0; u < side; ++u)
            for (std::uint32_t v = 0; v < side; ++v) {
                std::array<std::uint32_t, 4> corners{grid.vertex(face, u, v),
                                                     grid.vertex(face, u + 1, v),
                                                     grid.vertex(face, u, v + 1),
                                                     grid.vertex(face, u + 1, v + 1)};
                if (face % 2 == 0) // turn it outwards
                    std::swap(corners[1], corners[2]);
                for (const std::uint32_t corner : {0u, 1u, 2u, 1u, 3u, 2u})
                    geometry->indices.push_back(corners[corner]);
            }
    geometry->positions = grid.takePositions();
    SceneBuilder builder("sphere");
    const std::uint32_t submesh =
        builder.addSubmesh({"sphere", {{PrimitiveMode::Triangles, std::move(geometry)}}});
    builder.addNode("sphere", kNone, glm::dmat4(1.0), submesh);
    return builder.finish();
}

} // namespace lodestone::bench
