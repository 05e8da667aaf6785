#include "scene/generate.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <gtest/gtest.h>
#include <map>
#include <set>

namespace lodestone {

namespace {

ScenePtr make(std::string_view name, std::uint64_t seed = 1) {
    Result<ScenePtr> scene = generateScene(name, seed);
    EXPECT_TRUE(scene.has_value());
    return *scene;
}

// Seed 1, made once.
const Scene& sample(std::string_view name) {
    static std::map<std::string_view, ScenePtr> made;
    ScenePtr& scene = made[name];
    if (!scene)
        scene = make(name);
    return *scene;
}

const Geometry& geometryOf(const Submesh& submesh) {
    return *submesh.primitives.at(0).geometry;
}

const Submesh& named(const Scene& scene, std::string_view name) {
    const auto found = std::ranges::find(scene.submeshes, name, &Submesh::name);
    EXPECT_NE(found, scene.submeshes.end()) << name;
    return *found;
}

struct Topology {
    std::size_t vertices = 0;
    std::size_t edges = 0;
    std::size_t faces = 0;
    std::size_t open_edges = 0;     // not used once each way
    std::size_t split_vertices = 0; // whose triangles are not one fan
};

// Vertices at bit-equal positions count as one.
Topology topologyOf(const Geometry& geometry) {
    std::map<std::array<float, 3>, std::uint32_t> ids;
    std::vector<std::uint32_t> id_of;
    for (const glm::vec3& p : geometry.positions)
        id_of.push_back(
            ids.try_emplace({p.x, p.y, p.z}, static_cast<std::uint32_t>(ids.size())).first->second);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> directed;
    std::vector<std::map<std::uint32_t, std::uint32_t>> next(ids.size()); // around each vertex
    for (std::size_t i = 0; i < geometry.indices.size(); i += 3)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = id_of[geometry.indices[i + k]];
            const std::uint32_t b = id_of[geometry.indices[i + (k + 1) % 3]];
            ++directed[{a, b}];
            next[a][b] = id_of[geometry.indices[i + (k + 2) % 3]];
        }
    Topology topology{ids.size(), 0, geometry.triangleCount(), 0, 0};
    for (const auto& [edge, uses] : directed) {
        const auto back = directed.find({edge.second, edge.first});
        topology.open_edges += back == directed.end() || back->second != uses;
        topology.edges += edge.first < edge.second || back == directed.end();
    }
    for (const auto& around : next) {
        std::size_t steps = 0;
        for (std::uint32_t at = around.begin()->first; steps <= around.size(); ++steps) {
            const auto step = around.find(at);
            if (step == around.end() || (steps > 0 && at == around.begin()->first))
                break;
            at = step->second;
        }
        topology.split_vertices += steps != around.size();
    }
    return topology;
}

double signedVolume(const Geometry& geometry) {
    double six_volumes = 0.0;
    for (std::size_t i = 0; i < geometry.indices.size(); i += 3) {
        const glm::dvec3 a(geometry.positions[geometry.indices[i]]);
        const glm::dvec3 b(geometry.positions[geometry.indices[i + 1]]);
        const glm::dvec3 c(geometry.positions[geometry.indices[i + 2]]);
        six_volumes += glm::dot(a, glm::cross(b, c));
    }
    return six_volumes / 6.0;
}

// A solid is what has no open parts: everything but leaves, grass, seeds and the ground.
bool isSolid(const std::string& name) {
    for (const std::string_view open : {"leaf", "grass", "seeds", "ground"})
        if (name.find(open) != std::string::npos)
            return false;
    return true;
}

bool sameScene(const Scene& a, const Scene& b) {
    if (a.submeshes.size() != b.submeshes.size() || a.instances.size() != b.instances.size())
        return false;
    for (std::size_t s = 0; s < a.submeshes.size(); ++s) {
        const Geometry& ga = geometryOf(a.submeshes[s]);
        const Geometry& gb = geometryOf(b.submeshes[s]);
        if (ga.positions != gb.positions || ga.indices != gb.indices ||
            ga.attributes[0].bytes != gb.attributes[0].bytes)
            return false;
    }
    return std::ranges::equal(a.instances, b.instances, [](const Instance& x, const Instance& y) {
        return x.submesh == y.submesh && x.transform == y.transform;
    });
}

} // namespace

TEST(Generate, ChairHasTheCountsOfThePaper) {
    const SceneCounts counts = countScene(sample("chair"));
    EXPECT_EQ(counts.submeshes, 6u);
    EXPECT_EQ(counts.instances, 68u);
    EXPECT_EQ(counts.triangles, 2240u);
}

TEST(Generate, MapleHasTheCountsOfThePaperWhateverTheSeed) {
    for (const std::uint64_t seed : {1u, 2u, 77u}) {
        const SceneCounts counts = countScene(*make("maple", seed));
        EXPECT_EQ(counts.submeshes, 18u);
        EXPECT_EQ(counts.instances, 9324u);
        EXPECT_EQ(counts.triangles, 1818074u);
        EXPECT_LE(counts.unique_triangles, 90000u);
    }
}

TEST(Generate, VillageHasTheCountsOfThePaperWhateverTheSeed) {
    for (const std::uint64_t seed : {1u, 2u, 77u}) {
        const SceneCounts counts = countScene(*make("village", seed));
        EXPECT_EQ(counts.submeshes, 79u);
        EXPECT_EQ(counts.instances, 13523u);
        EXPECT_EQ(counts.triangles, 1254696u);
        EXPECT_LE(counts.unique_triangles, 100000u);
    }
}

TEST(Generate, BunnyIsOneClosedManifoldWithoutHandles) {
    const Scene& scene = sample("bunny");
    const SceneCounts counts = countScene(scene);
    EXPECT_EQ(counts.submeshes, 1u);
    EXPECT_EQ(counts.instances, 1u);
    EXPECT_GE(counts.triangles, 69000u);
    EXPECT_LE(counts.triangles, 70000u);
    const Geometry& geometry = geometryOf(scene.submeshes[0]);
    const Topology topology = topologyOf(geometry);
    EXPECT_EQ(topology.open_edges, 0u);
    EXPECT_EQ(topology.split_vertices, 0u);
    EXPECT_EQ(topology.vertices + topology.faces, topology.edges + 2);
    EXPECT_GT(signedVolume(geometry), 0.0);
}

TEST(Generate, BunnyIsSampledUnevenly) {
    const Scene& scene = sample("bunny");
    const Geometry& geometry = geometryOf(scene.submeshes[0]);
    std::vector<double> areas;
    for (std::size_t i = 0; i < geometry.indices.size(); i += 3) {
        const glm::dvec3 a(geometry.positions[geometry.indices[i]]);
        const glm::dvec3 b(geometry.positions[geometry.indices[i + 1]]);
        const glm::dvec3 c(geometry.positions[geometry.indices[i + 2]]);
        areas.push_back(glm::length(glm::cross(b - a, c - a)));
    }
    std::ranges::sort(areas);
    EXPECT_GT(areas[areas.size() * 9 / 10], 2.5 * areas[areas.size() / 10]);
}

TEST(Generate, SolidsAreClosedAndFaceOutward) {
    for (const std::string_view name : sampleNames())
        for (const Submesh& submesh : sample(name).submeshes)
            if (isSolid(submesh.name)) {
                EXPECT_EQ(topologyOf(geometryOf(submesh)).open_edges, 0u)
                    << name << " " << submesh.name;
                EXPECT_GT(signedVolume(geometryOf(submesh)), 0.0) << name << " " << submesh.name;
            }
}

TEST(Generate, EverySubmeshIsCleanGeometry) {
    for (const std::string_view name : sampleNames())
        for (const Submesh& submesh : sample(name).submeshes) {
            ASSERT_EQ(submesh.primitives.size(), 1u);
            const Geometry& geometry = geometryOf(submesh);
            std::vector<bool> used(geometry.positions.size(), false);
            for (const std::uint32_t index : geometry.indices) {
                ASSERT_LT(index, geometry.positions.size());
                used[index] = true;
            }
            EXPECT_TRUE(std::ranges::all_of(used, [](bool u) { return u; })) << submesh.name;
            std::size_t degenerate = 0;
            for (std::size_t i = 0; i < geometry.indices.size(); i += 3) {
                const glm::dvec3 a(geometry.positions[geometry.indices[i]]);
                const glm::dvec3 b(geometry.positions[geometry.indices[i + 1]]);
                const glm::dvec3 c(geometry.positions[geometry.indices[i + 2]]);
                const double longest =
                    std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
                degenerate += !(glm::length(glm::cross(b - a, c - a)) > 1e-6 * longest * longest);
            }
            EXPECT_EQ(degenerate, 0u) << name << " " << submesh.name;
        }
}

TEST(Generate, NormalsAreUnitAndOnTheTrianglesSide) {
    for (const std::string_view name : sampleNames())
        for (const Submesh& submesh : sample(name).submeshes) {
            const Geometry& geometry = geometryOf(submesh);
            const Attribute* normals = findAttribute(geometry.attributes, "NORMAL");
            ASSERT_NE(normals, nullptr);
            const auto normalAt = [&](std::uint32_t v) {
                return glm::dvec3(attributeValue(*normals, v, 0),
                                  attributeValue(*normals, v, 1),
                                  attributeValue(*normals, v, 2));
            };
            for (std::uint32_t v = 0; v < geometry.positions.size(); ++v)
                ASSERT_NEAR(glm::length(normalAt(v)), 1.0, 1e-5) << submesh.name;
            std::size_t turned = 0;
            for (std::size_t i = 0; i < geometry.indices.size(); i += 3) {
                const glm::dvec3 a(geometry.positions[geometry.indices[i]]);
                const glm::dvec3 b(geometry.positions[geometry.indices[i + 1]]);
                const glm::dvec3 c(geometry.positions[geometry.indices[i + 2]]);
                glm::dvec3 mean(0.0);
                for (std::size_t k = 0; k < 3; ++k)
                    mean += normalAt(geometry.indices[i + k]);
                turned += glm::dot(mean, glm::cross(b - a, c - a)) <= 0.0;
            }
            EXPECT_LE(turned, geometry.triangleCount() / 50) << name << " " << submesh.name;
        }
}

TEST(Generate, EveryInstanceIsAFoldableLeafThatIsNotMirrored) {
    for (const std::string_view name : sampleNames()) {
        const Scene& scene = sample(name);
        for (const Instance& instance : scene.instances) {
            ASSERT_TRUE(scene.nodes[instance.node].foldable) << scene.nodes[instance.node].name;
            ASSERT_GT(glm::determinant(glm::dmat3(instance.transform)), 0.0);
        }
        EXPECT_TRUE(std::ranges::all_of(instanceRanges(scene),
                                        [](const InstanceRange& r) { return r.size() > 0; }));
    }
}

TEST(Generate, SameSeedGivesTheSameSceneAndAnotherSeedAnother) {
    for (const std::string_view name : sampleNames()) {
        EXPECT_TRUE(sameScene(*make(name, 5), *make(name, 5))) << name;
        EXPECT_FALSE(sameScene(*make(name, 5), *make(name, 6))) << name;
    }
}

TEST(Generate, TreesOfTheVillageAreOfVeryDifferentScales) {
    const Scene& scene = sample("village");
    double smallest = 1e9;
    double largest = 0.0;
    for (const Instance& instance : scene.instances)
        if (scene.submeshes[instance.submesh].name == "oak trunk") {
            const double scale = glm::length(glm::dvec3(instance.transform[1]));
            smallest = std::min(smallest, scale);
            largest = std::max(largest, scale);
        }
    EXPECT_LT(smallest, 0.5);
    EXPECT_NEAR(largest, 4.0, 1e-9);
}

TEST(Generate, HousesOfTheVillageKeepTheirDistance) {
    const Scene& scene = sample("village");
    std::vector<glm::dvec2> houses;
    for (const Instance& instance : scene.instances) {
        const std::string& name = scene.submeshes[instance.submesh].name;
        if (name.starts_with("house") && name.ends_with("walls"))
            houses.emplace_back(instance.transform[3].x, instance.transform[3].z);
    }
    EXPECT_GT(houses.size(), 80u);
    for (std::size_t a = 0; a < houses.size(); ++a)
        for (std::size_t b = 0; b < a; ++b)
            ASSERT_GT(glm::length(houses[a] - houses[b]), 13.4);
}

TEST(Generate, LeavesAreDetailedDoubleSidedAndOfDifferentColors) {
    const Scene& scene = sample("maple");
    std::set<std::array<float, 3>> colors;
    for (const Submesh& submesh : scene.submeshes)
        if (submesh.name.starts_with("leaf")) {
            EXPECT_GE(triangleCount(submesh), 150u);
            const Material& material = scene.materials[submesh.primitives[0].material];
            EXPECT_TRUE(material.double_sided);
            colors.insert({material.base_color.r, material.base_color.g, material.base_color.b});
        }
    EXPECT_EQ(colors.size(), 8u);
    EXPECT_FALSE(scene.materials[named(scene, "trunk").primitives[0].material].double_sided);
}

TEST(Generate, AnUnknownNameIsAUsageErrorThatNamesTheChoices) {
    const Result<ScenePtr> scene = generateScene("teapot");
    ASSERT_FALSE(scene.has_value());
    EXPECT_EQ(scene.error().kind, ErrorKind::Usage);
    EXPECT_NE(scene.error().message.find("teapot"), std::string::npos);
    for (const std::string_view name : sampleNames())
        EXPECT_NE(scene.error().message.find(name), std::string::npos);
}

} // namespace lodestone
