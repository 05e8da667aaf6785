#include "simplify/collapse/removal_facts.h"

#include <cmath>

namespace lodestone {

namespace {

glm::dvec3 colorOf(const Scene& scene, const Primitive& primitive) {
    if (primitive.material >= scene.materials.size())
        return glm::dvec3(1.0);
    const glm::vec4 linear = scene.materials[primitive.material].base_color;
    return glm::sqrt(glm::clamp(glm::dvec3(linear), glm::dvec3(0.0), glm::dvec3(1.0)));
}

glm::dvec3 middleOf(const Submesh& submesh, std::size_t triangle) {
    for (const Primitive& primitive : submesh.primitives) {
        if (primitive.mode != PrimitiveMode::Triangles)
            continue;
        const Geometry& geometry = *primitive.geometry;
        if (triangle >= geometry.triangleCount()) {
            triangle -= geometry.triangleCount();
            continue;
        }
        glm::dvec3 sum(0.0);
        for (std::size_t k = 0; k < 3; ++k)
            sum += glm::dvec3(geometry.positions[geometry.indices[3 * triangle + k]]);
        return sum / 3.0;
    }
    return glm::dvec3(0.0);
}

struct Sums {
    double area = 0.0;
    glm::dvec3 color{0.0};
    glm::dvec3 centroid{0.0}; // x 3
    glm::dvec3 squares{0.0};  // of the normals' components
    glm::dvec3 products{0.0}; // xy, yz, zx
    std::vector<float> areas; // [triangles]
};

void addPrimitive(const Scene& scene, const Primitive& primitive, bool several, Sums& sums) {
    if (primitive.mode != PrimitiveMode::Triangles)
        return;
    const Geometry& geometry = *primitive.geometry;
    double all = 0.0;
    for (std::size_t i = 0; i + 2 < geometry.indices.size(); i += 3) {
        const glm::dvec3 a(geometry.positions[geometry.indices[i]]);
        const glm::dvec3 b(geometry.positions[geometry.indices[i + 1]]);
        const glm::dvec3 c(geometry.positions[geometry.indices[i + 2]]);
        const glm::dvec3 cross = glm::cross(b - a, c - a);
        const double area = 0.5 * glm::length(cross);
        all += area;
        if (!several)
            continue;
        sums.areas.push_back(static_cast<float>(area));
        if (!(area > 0.0))
            continue;
        const glm::dvec3 weighted = cross * (0.25 / area); // area x unit normal / length
        sums.squares += cross * weighted;
        sums.products += cross * glm::dvec3(weighted.y, weighted.z, weighted.x);
        sums.centroid += (a + b + c) * area;
    }
    sums.area += all;
    sums.color += colorOf(scene, primitive) * all;
}

void placePoints(const Submesh& submesh, const Sums& sums, SubmeshFacts& facts) {
    const auto count = static_cast<double>(facts.points.size());
    double passed = 0.0;
    std::size_t next = 0;
    for (std::size_t t = 0; t < sums.areas.size() && next < facts.points.size(); ++t) {
        passed += static_cast<double>(sums.areas[t]);
        while (next < facts.points.size() &&
               passed * count >= (static_cast<double>(next) + 0.5) * sums.area)
            facts.points[next++] = middleOf(submesh, t);
    }
    for (; next < facts.points.size(); ++next) // rounding
        facts.points[next] = facts.points[0];
}

} // namespace

SubmeshFacts factsOf(const Scene& scene, const Submesh& submesh, std::size_t instances) {
    const bool several = instances > 1;
    Sums sums;
    for (const Primitive& primitive : submesh.primitives)
        addPrimitive(scene, primitive, several, sums);
    SubmeshFacts facts;
    facts.area = sums.area;
    if (several)
        facts.bounds = localBounds(submesh);
    glm::dvec3 centroid(0.0);
    if (facts.area > 0.0) {
        facts.color = sums.color / facts.area;
        centroid = sums.centroid / (3.0 * facts.area);
        const glm::dvec3 squares = sums.squares / facts.area;
        const glm::dvec3 products = sums.products / facts.area;
        facts.normal_moment = glm::dmat3(squares.x,
                                         products.x,
                                         products.z,
                                         products.x,
                                         squares.y,
                                         products.y,
                                         products.z,
                                         products.y,
                                         squares.z);
        placePoints(submesh, sums, facts);
    }
    // The submesh's own origin if it lies in or near its box (a leaf's stalk), else its centroid.
    const glm::dvec3 margin(0.1 * facts.bounds.diagonal());
    const bool near = glm::all(glm::lessThanEqual(facts.bounds.min - margin, glm::dvec3(0.0))) &&
                      glm::all(glm::greaterThanEqual(facts.bounds.max + margin, glm::dvec3(0.0)));
    facts.pivot = near ? glm::dvec3(0.0) : centroid;
    return facts;
}

} // namespace lodestone
