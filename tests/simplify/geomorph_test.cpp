#include "app/lane_slide.h"
#include "simplify/geomorph.h"
#include "tests/simplify/meshes.h"

#include <algorithm>
#include <array>
#include <gtest/gtest.h>

namespace lodestone {

namespace {

using Triangle = std::array<std::array<float, 3>, 3>; // corners, the least one first

// A sphere that stands once, and one that stands in a crowd that gets thinned out.
LodSourcePtr spheres() {
    const ScenePtr scene =
        meshes::sceneOf({meshes::submeshOf({meshes::sphere(12, 16, 0.3), meshes::grid(6)}),
                         meshes::submeshOf({meshes::sphere(8, 10)})},
                        {{glm::dmat4(1.0)}, meshes::gridOfTransforms(4, 3.0)});
    return prepareEdgeCollapse(scene, {}, {}, {}).value();
}

// Sorted; those with two corners at one place are left out.
std::vector<Triangle> trianglesOf(const Geometry& geometry,
                                  const std::vector<std::uint32_t>& indices) {
    std::vector<Triangle> triangles;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        Triangle corners{};
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::vec3& p = geometry.positions[indices[i + k]];
            corners[k] = {p.x, p.y, p.z};
        }
        if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0])
            continue;
        std::rotate(
            corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        triangles.push_back(corners);
    }
    std::ranges::sort(triangles);
    return triangles;
}

struct Span {
    std::uint64_t fine;
    std::uint64_t coarse;
};

std::vector<Span> spansOf(const LodSource& source) {
    const std::uint64_t last = source.positionCount() - 1;
    return {{0, last / 4}, {last / 5, last / 2}, {last / 2, last}, {last, last}};
}

const GeomorphSource& geomorphsOf(const LodSourcePtr& source) {
    return dynamic_cast<const GeomorphSource&>(*source);
}

double furthest(const Lod& a, const Lod& b) {
    double distance = 0.0;
    for (std::size_t s = 0; s < a.submeshes.size(); ++s)
        for (std::size_t p = 0; p < a.submeshes[s].primitives.size(); ++p) {
            const Geometry& from = *a.submeshes[s].primitives[p];
            const Geometry& to = *b.submeshes[s].primitives[p];
            if (from.positions.size() != to.positions.size())
                return std::numeric_limits<double>::infinity();
            for (std::size_t v = 0; v < from.positions.size(); ++v)
                distance =
                    std::max(distance, double(glm::distance(from.positions[v], to.positions[v])));
        }
    return distance;
}

} // namespace

TEST(Geomorph, EndsWhereTheCoarserLodHasItsTriangles) {
    const LodSourcePtr source = spheres();
    for (const Span& span : spansOf(*source)) {
        const Geomorph geomorph = geomorphsOf(source).geomorph(span.fine, span.coarse);
        const Lod coarse = source->readOut(span.coarse, nullptr);
        for (std::size_t s = 0; s < geomorph.ends.size(); ++s)
            for (std::size_t p = 0; p < geomorph.ends[s].size(); ++p) {
                const Geometry& wanted = *coarse.submeshes[s].primitives[p];
                EXPECT_EQ(trianglesOf(*geomorph.ends[s][p],
                                      geomorph.fine.submeshes[s].primitives[p]->indices),
                          trianglesOf(wanted, wanted.indices))
                    << "submesh " << s << " from " << span.fine << " to " << span.coarse;
            }
    }
}

TEST(Geomorph, BeginsAtTheFinerLod) {
    const LodSourcePtr source = spheres();
    for (const Span& span : spansOf(*source)) {
        const Lod at_begin = slid(geomorphsOf(source).geomorph(span.fine, span.coarse), 0.0);
        const Lod fine = source->readOut(span.fine, nullptr);
        EXPECT_EQ(at_begin.triangles, fine.triangles);
        EXPECT_EQ(at_begin.instances, fine.instances);
        for (std::size_t s = 0; s < fine.submeshes.size(); ++s)
            for (std::size_t p = 0; p < fine.submeshes[s].primitives.size(); ++p) {
                const Geometry& a = *at_begin.submeshes[s].primitives[p];
                const Geometry& b = *fine.submeshes[s].primitives[p];
                EXPECT_EQ(trianglesOf(a, a.indices), trianglesOf(b, b.indices));
            }
    }
}

TEST(Geomorph, VerticesAndFloatAttributesAreHalfWayAtTheMiddle) {
    const LodSourcePtr source = spheres();
    const Geomorph geomorph = geomorphsOf(source).geomorph(0, source->positionCount() / 3);
    const Lod middle = slid(geomorph, 0.5);
    const Geometry& from = *geomorph.fine.submeshes[0].primitives[0];
    const Geometry& end = *geomorph.ends[0][0];
    const Geometry& at = *middle.submeshes[0].primitives[0];
    ASSERT_EQ(at.positions.size(), end.positions.size());
    EXPECT_GT(furthest(geomorph.fine, middle), 0.0);
    for (std::size_t v = 0; v < at.positions.size(); ++v)
        EXPECT_LT(glm::distance(at.positions[v], (from.positions[v] + end.positions[v]) * 0.5f),
                  1e-6f);
    for (std::size_t a = 0; a < at.attributes.size(); ++a)
        EXPECT_NEAR(attributeValue(at.attributes[a], 7, 0),
                    0.5f * (attributeValue(from.attributes[a], 7, 0) +
                            attributeValue(end.attributes[a], 7, 0)),
                    1e-5f);
}

TEST(LaneSlide, MovesVerticesLittleWhereTheRatioDoes) {
    const LodSourcePtr source = spheres();
    LaneSlide slide;
    double most = 0.0;
    int jumps = 0;
    std::shared_ptr<const Lod> last = slide.at(source, 1.0);
    for (double ratio = 1.0; ratio > 0.1; ratio *= 0.99) {
        const auto next = slide.at(source, ratio);
        const double moved = furthest(*last, *next);
        if (std::isinf(moved))
            ++jumps; // the next two LODs: other vertices, the same surface
        else
            most = std::max(most, moved);
        last = next;
    }
    EXPECT_LT(most, 0.2) << "of a sphere of radius 1";
    EXPECT_LE(jumps, 11) << "a fifth of the triangles apart";
    EXPECT_GE(jumps, 5);
}

TEST(LaneSlide, GoesUpThroughTheLodsThatItCameDown) {
    const LodSourcePtr source = spheres();
    LaneSlide down;
    LaneSlide up;
    const auto first = down.at(source, 0.47);
    up.at(source, 0.2);
    EXPECT_EQ(furthest(*first, *up.at(source, 0.47)), 0.0);
}

} // namespace lodestone
