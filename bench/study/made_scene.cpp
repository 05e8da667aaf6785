#include "bench/study/made_scene.h"

#include "scene/generate/mesh_maker.h"
#include "scene/scene_builder.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace lodestone::bench {

using generate::kPi;
using generate::Mesh;
using generate::Random;

namespace {

enum class Shape : std::uint8_t { Box, Bar, Turned, Tube, Ball, Panel, Leaf };

// Whole number of at least `least`, near to the value.
int wholeNumber(double value, int least) {
    return std::max(least, static_cast<int>(std::lround(value)));
}

Mesh box(Random& random, std::uint32_t faces) {
    Mesh mesh;
    const glm::dvec3 half(random.in(0.2, 0.5), random.in(0.2, 0.5), random.in(0.2, 0.5));
    generate::addBox(mesh, -half, half);
    generate::refineTo(mesh, std::max<std::size_t>(12, std::size_t{faces} / 2 * 2));
    return mesh;
}

Mesh bar(Random& random, std::uint32_t faces) {
    Mesh mesh;
    generate::BevelledBar made;
    made.width_x = random.in(0.05, 0.2);
    made.depth_z = random.in(0.03, 0.05);
    made.length = random.in(0.6, 1.4);
    made.segments = wholeNumber((faces - 28.0) / 16.0, 1);
    made.bow = {random.in(-0.1, 0.1), random.in(-0.1, 0.1)};
    generate::addBevelledBar(mesh, made);
    return mesh;
}

Mesh turned(Random& random, std::uint32_t faces) {
    const int sides = wholeNumber(std::sqrt(0.5 * faces), 5);
    const int rings = wholeNumber(0.5 * faces / sides, 2);
    const double waves = random.in(0.5, 3.0);
    const double start = random.in(0.0, 6.0);
    std::vector<glm::dvec2> profile;
    for (int ring = 0; ring < rings; ++ring) {
        const double t = static_cast<double>(ring) / (rings - 1);
        profile.emplace_back(0.25 + 0.12 * generate::sine(start + 2.0 * kPi * waves * t), t - 0.5);
    }
    Mesh mesh;
    generate::addTurned(mesh, profile, sides);
    return mesh;
}

Mesh tube(Random& random, std::uint32_t faces) {
    const int sides = wholeNumber(std::sqrt(0.25 * faces), 4);
    const int joints = wholeNumber(0.5 * faces / sides, 2);
    const double bend = random.in(0.0, 0.4);
    const double start = random.in(0.0, 6.0);
    std::vector<generate::PathPoint> path;
    for (int joint = 0; joint < joints; ++joint) {
        const double t = static_cast<double>(joint) / (joints - 1);
        path.push_back(
            {{bend * generate::sine(start + 3.0 * t), t - 0.5, bend * t * t}, 0.12 - 0.06 * t});
    }
    Mesh mesh;
    generate::addTube(mesh, path, sides);
    return mesh;
}

Mesh ball(Random& random, std::uint32_t faces) {
    Mesh mesh = generate::ball(wholeNumber(0.5 * std::log2(faces / 20.0), 0));
    const auto seed = static_cast<std::uint32_t>(random.bits());
    const double depth = random.in(0.05, 0.3);
    for (glm::dvec3& p : mesh.positions)
        p *= 0.4 * (1.0 + depth * generate::fractalNoise(2.0 * p, seed, 3));
    return mesh;
}

// Open, of a square grid; bend: how far it leaves its plane.
Mesh patch(Random& random, std::uint32_t faces, double bend) {
    const int side = wholeNumber(std::sqrt(0.5 * faces), 1);
    const auto seed = static_cast<std::uint32_t>(random.bits());
    const double width = random.in(0.4, 1.0);
    Mesh mesh;
    for (int row = 0; row <= side; ++row)
        for (int column = 0; column <= side; ++column) {
            const glm::dvec2 at(static_cast<double>(column) / side - 0.5,
                                static_cast<double>(row) / side - 0.5);
            const double lift =
                bend * generate::fractalNoise({3.0 * at.x, 3.0 * at.y, 0.0}, seed, 3);
            mesh.addVertex({width * at.x, at.y, lift});
        }
    const auto vertex = [side](int row, int column) {
        return static_cast<std::uint32_t>(row * (side + 1) + column);
    };
    for (int row = 0; row < side; ++row)
        for (int column = 0; column < side; ++column)
            mesh.addQuad(vertex(row, column),
                         vertex(row, column + 1),
                         vertex(row + 1, column + 1),
                         vertex(row + 1, column));
    return mesh;
}

Mesh makeShape(Shape shape, Random& random, std::uint32_t faces) {
    switch (shape) {
    case Shape::Box:
        return box(random, faces);
    case Shape::Bar:
        return bar(random, faces);
    case Shape::Turned:
        return turned(random, faces);
    case Shape::Tube:
        return tube(random, faces);
    case Shape::Ball:
        return ball(random, faces);
    case Shape::Panel:
        return patch(random, faces, 0.02);
    case Shape::Leaf:
        break;
    }
    return patch(random, faces, 0.15);
}

std::vector<Shape> shapesOf(SceneKind kind) {
    switch (kind) {
    case SceneKind::Object:
        return {Shape::Ball, Shape::Turned, Shape::Tube, Shape::Box};
    case SceneKind::Furniture:
        return {Shape::Bar, Shape::Turned, Shape::Box};
    case SceneKind::Facade:
        return {Shape::Box, Shape::Panel, Shape::Bar};
    case SceneKind::Machine:
        return {Shape::Turned, Shape::Tube, Shape::Box};
    case SceneKind::Forest:
        return {Shape::Leaf, Shape::Leaf, Shape::Tube};
    case SceneKind::City:
        break;
    }
    return {Shape::Box, Shape::Panel, Shape::Ball, Shape::Turned};
}

glm::dmat4 anyTurn(Random& random) {
    return generate::rotatedX(random.in(0.0, 2.0 * kPi)) *
           generate::rotatedY(random.in(0.0, 2.0 * kPi)) *
           generate::rotatedZ(random.in(0.0, 2.0 * kPi));
}

glm::dmat4 inRing(Random& random, std::uint32_t i, std::uint32_t count) {
    const double angle = 2.0 * kPi * i / count;
    return generate::rotatedY(angle) * generate::moved({random.in(1.9, 2.1), 0.0, 0.0});
}

// A place in a square grid about the origin, steps apart.
glm::dvec3 inGrid(std::uint32_t i, std::uint32_t count, double step) {
    const auto side =
        std::max(1U, static_cast<std::uint32_t>(std::ceil(std::sqrt(static_cast<double>(count)))));
    const std::uint32_t row = i / side;
    const std::uint32_t column = i % side;
    return {step * (column - 0.5 * (side - 1)), 0.0, step * (row - 0.5 * (side - 1))};
}

glm::dmat4 inCrown(Random& random) {
    const double angle = random.in(0.0, 2.0 * kPi);
    const double height = random.in(0.0, 1.0);
    const double radius = 4.0 * std::sqrt(height * (1.0 - height)) * std::sqrt(random.in(0.2, 1.0));
    return generate::moved({radius * generate::cosine(angle),
                            2.0 + 6.0 * height,
                            radius * generate::sine(angle)}) *
           anyTurn(random) * generate::scaled(glm::dvec3(random.in(0.1, 0.4)));
}

// Sizes over three decades, small ones near the ground, one in six sheared.
glm::dmat4 inCity(Random& random) {
    const double size = std::pow(10.0, random.in(-2.0, 1.0));
    glm::dmat4 place =
        generate::moved({random.in(-30.0, 30.0), 0.5 * size, random.in(-30.0, 30.0)}) *
        generate::rotatedY(random.in(0.0, 2.0 * kPi)) *
        generate::scaled(glm::dvec3(size, size * random.in(0.5, 3.0), size));
    if (random.below(6) == 0) {
        glm::dmat4 shear(1.0);
        shear[1][0] = random.in(-0.5, 0.5);
        place *= shear;
    }
    return place;
}

// Instance i of `count` of a submesh.
glm::dmat4 placeOf(SceneKind kind, Random& random, std::uint32_t i, std::uint32_t count) {
    switch (kind) {
    case SceneKind::Object:
        return generate::moved(inGrid(i, count, 0.8) + glm::dvec3(0.0, random.in(0.0, 0.5), 0.0)) *
               generate::rotatedY(random.in(0.0, 2.0 * kPi));
    case SceneKind::Furniture:
        return generate::moved({0.3 * i, 0.0, 0.0}) *
               generate::scaled({random.below(4) == 0 ? -1.0 : 1.0, 1.0, 1.0});
    case SceneKind::Facade:
        return generate::moved(inGrid(i, count, 1.2)) *
               generate::scaled({random.in(0.5, 1.1), random.in(0.5, 1.1), random.in(0.2, 1.1)});
    case SceneKind::Machine:
        return inRing(random, i, count);
    case SceneKind::Forest:
        return inCrown(random);
    case SceneKind::City:
        break;
    }
    return inCity(random);
}

// How many instances each submesh has: uneven, at least one.
std::vector<std::uint32_t> shareOut(const SceneRecipe& recipe, Random& random) {
    std::vector<double> weights;
    double sum = 0.0;
    for (std::uint32_t s = 0; s < recipe.submeshes; ++s) {
        weights.push_back(std::pow(random.in(0.02, 1.0), 2.0));
        sum += weights.back();
    }
    std::vector<std::uint32_t> counts(recipe.submeshes, 1);
    std::uint32_t left = recipe.instances - recipe.submeshes;
    const std::uint32_t all = left;
    for (std::uint32_t s = 0; s < recipe.submeshes; ++s) {
        const auto share =
            std::min(left, static_cast<std::uint32_t>(std::floor(all * weights[s] / sum)));
        counts[s] += share;
        left -= share;
    }
    counts.front() += left;
    return counts;
}

Material materialOf(std::uint32_t number, Random& random) {
    Material material;
    material.name = "material " + std::to_string(number);
    material.base_color = {random.in(0.2, 0.9), random.in(0.2, 0.9), random.in(0.2, 0.9), 1.0};
    material.metallic = 0.0F;
    material.double_sided = true;
    return material;
}

} // namespace

const char* kindName(SceneKind kind) {
    switch (kind) {
    case SceneKind::Object:
        return "object";
    case SceneKind::Furniture:
        return "furniture";
    case SceneKind::Facade:
        return "facade";
    case SceneKind::Machine:
        return "machine";
    case SceneKind::Forest:
        return "forest";
    case SceneKind::City:
        break;
    }
    return "city";
}

ScenePtr makeScene(const SceneRecipe& recipe) {
    constexpr double kCrease = 0.7;      // radians
    constexpr std::uint32_t kBlock = 40; // instances under one node
    Random random(recipe.seed);
    SceneBuilder builder(std::string(kindName(recipe.kind)) + " " + std::to_string(recipe.seed));
    const std::uint32_t materials = 1 + random.below(4);
    for (std::uint32_t m = 0; m < materials; ++m)
        builder.addMaterial(materialOf(m, random));
    const std::vector<Shape> shapes = shapesOf(recipe.kind);
    const std::vector<std::uint32_t> counts = shareOut(recipe, random);
    for (std::uint32_t s = 0; s < recipe.submeshes; ++s) {
        const Shape shape = shapes[random.below(static_cast<std::uint32_t>(shapes.size()))];
        const auto faces = static_cast<std::uint32_t>(recipe.part_faces * random.in(0.4, 1.6));
        Submesh submesh;
        submesh.name = "part " + std::to_string(s);
        submesh.primitives.push_back({});
        submesh.primitives[0].geometry =
            generate::makeGeometry(makeShape(shape, random, std::max(2U, faces)), kCrease);
        submesh.primitives[0].material = s % materials;
        builder.addSubmesh(std::move(submesh));
        std::uint32_t block = kNone;
        for (std::uint32_t i = 0; i < counts[s]; ++i) {
            if (i % kBlock == 0)
                block = builder.addNode("group",
                                        kNone,
                                        generate::moved({random.in(-2.0, 2.0), 0.0, 0.6 * s}) *
                                            generate::rotatedY(random.in(0.0, 0.3)));
            builder.addNode("piece", block, placeOf(recipe.kind, random, i, counts[s]), s);
        }
    }
    return builder.finish();
}

} // namespace lodestone::bench
