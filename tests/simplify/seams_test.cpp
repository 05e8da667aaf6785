#include "tests/simplify/meshes.h"

#include <array>
#include <cmath>
#include <cstring>
#include <gtest/gtest.h>
#include <set>

namespace lodestone {

namespace {

using meshes::readAt;
using meshes::sequenceOf;
using meshes::submeshOf;

// Vertices of a closed sphere split along a meridian and a parallel: other texture coordinates,
// same places.
GeometryPtr seamedSphere() {
    const GeometryPtr plain = meshes::sphere(12, 16);
    auto seamed = std::make_shared<Geometry>();
    std::vector<float> normals;
    std::vector<float> texcoords;
    for (std::size_t t = 0; t < plain->triangleCount(); ++t) {
        glm::vec3 middle(0.0f);
        for (std::size_t k = 0; k < 3; ++k)
            middle += plain->positions[plain->indices[3 * t + k]] / 3.0f;
        const float chart = (middle.x > 0.0f ? 1.0f : 0.0f) + (middle.z > 0.0f ? 2.0f : 0.0f);
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::vec3 p = plain->positions[plain->indices[3 * t + k]];
            const glm::vec3 n = glm::normalize(p);
            seamed->indices.push_back(static_cast<std::uint32_t>(seamed->positions.size()));
            seamed->positions.push_back(p);
            normals.insert(normals.end(), {n.x, n.y, n.z});
            texcoords.insert(texcoords.end(), {0.25f * chart + 0.1f * p.y, 0.5f * p.z});
        }
    }
    return meshes::withAttribute(
        *meshes::withAttribute(*seamed, "NORMAL", normals), "TEXCOORD_0", texcoords);
}

// A cube of flat sides: every edge a normal seam.
GeometryPtr facetedSphere() {
    const GeometryPtr plain = meshes::sphere(8, 10);
    auto faceted = std::make_shared<Geometry>();
    std::vector<float> normals;
    for (std::size_t t = 0; t < plain->triangleCount(); ++t) {
        std::array<glm::vec3, 3> p;
        for (std::size_t k = 0; k < 3; ++k)
            p[k] = plain->positions[plain->indices[3 * t + k]];
        const glm::vec3 n = glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
        for (const glm::vec3& corner : p) {
            faceted->indices.push_back(static_cast<std::uint32_t>(faceted->positions.size()));
            faceted->positions.push_back(corner);
            normals.insert(normals.end(), {n.x, n.y, n.z});
        }
    }
    return meshes::withAttribute(*faceted, "NORMAL", normals);
}

// One sphere in two materials: the primitives share places but no vertices.
Submesh twoMaterials() {
    const GeometryPtr plain = meshes::sphere(12, 16);
    std::array<std::shared_ptr<Geometry>, 2> halves{std::make_shared<Geometry>(*plain),
                                                    std::make_shared<Geometry>(*plain)};
    for (const auto& half : halves)
        half->indices.clear();
    for (std::size_t i = 0; i < plain->indices.size(); i += 3) {
        const bool upper = plain->positions[plain->indices[i]].z > 0.1f;
        for (std::size_t k = 0; k < 3; ++k)
            halves[upper ? 1 : 0]->indices.push_back(plain->indices[i + k]);
    }
    return submeshOf({halves[0], halves[1]});
}

void expectNoCrackAtAnyStep(const Submesh& submesh) {
    const CollapseSequence sequence = sequenceOf(submesh);
    for (std::uint32_t step = 0; step <= sequence.step_count; ++step) {
        const meshes::Shape shape = meshes::shapeOf(readAt(sequence, submesh, step));
        ASSERT_EQ(shape.border_edges, 0u) << "step " << step << ", " << shape.faces << " faces";
        ASSERT_EQ(shape.degenerate_faces, 0u) << "step " << step;
    }
    EXPECT_EQ(sequence.facesAt(sequence.step_count), 4u);
}

// Attributes of every vertex of every step.
template <class Check>
void forEveryVertex(const Submesh& submesh, std::string_view semantic, Check check) {
    const CollapseSequence sequence = sequenceOf(submesh);
    for (std::uint32_t step = 0; step <= sequence.step_count; ++step)
        for (const GeometryPtr& geometry : readAt(sequence, submesh, step)) {
            const Attribute* attribute = findAttribute(geometry->attributes, semantic);
            ASSERT_NE(attribute, nullptr);
            ASSERT_EQ(attribute->bytes.size(), geometry->positions.size() * attribute->stride());
            for (std::size_t v = 0; v < geometry->positions.size(); ++v) {
                glm::vec4 value(0.0f);
                for (int c = 0; c < attribute->components; ++c)
                    value[c] = attributeValue(*attribute, v, static_cast<std::size_t>(c));
                check(value);
                if (::testing::Test::HasFailure())
                    return;
            }
        }
}

// A grid of joints 0..6 with two weights a vertex; every vertex has its own pair.
GeometryPtr skinnedGrid() {
    auto geometry = std::make_shared<Geometry>(*meshes::grid(8));
    Attribute joints{"JOINTS_0", ComponentType::UInt8, 4, false, {}};
    std::vector<float> weights;
    for (const glm::vec3& p : geometry->positions) {
        const int first = static_cast<int>(p.x * 5.0f);
        for (const int joint : {first, first + 1, 0, 0})
            joints.bytes.push_back(static_cast<std::byte>(joint));
        weights.insert(weights.end(), {1.0f - p.y * 0.5f, p.y * 0.5f, 0.0f, 0.0f});
    }
    geometry->attributes.push_back(joints);
    return meshes::withAttribute(*geometry, "WEIGHTS_0", weights);
}

} // namespace

TEST(Seams, NoCrackOpensAlongTextureSeams) {
    expectNoCrackAtAnyStep(submeshOf({seamedSphere()}));
}

TEST(Seams, NoCrackOpensWhereEveryEdgeIsANormalSeam) {
    expectNoCrackAtAnyStep(submeshOf({facetedSphere()}));
}

TEST(Seams, NoCrackOpensBetweenMaterials) {
    expectNoCrackAtAnyStep(twoMaterials());
}

TEST(Seams, NormalsStayUnitVectors) {
    for (const GeometryPtr& geometry : {seamedSphere(), facetedSphere()})
        forEveryVertex(submeshOf({geometry}), "NORMAL", [](const glm::vec4& value) {
            EXPECT_NEAR(glm::length(glm::vec3(value)), 1.0f, 1e-4f);
        });
}

TEST(Seams, OppositeNormalsStillBlendToAUnitVector) {
    const GeometryPtr flat = meshes::grid(6);
    std::vector<float> normals;
    for (std::size_t v = 0; v < flat->positions.size(); ++v)
        normals.insert(normals.end(), {0.0f, 0.0f, v % 2 == 0 ? 1.0f : -1.0f});
    forEveryVertex(
        submeshOf({meshes::withAttribute(*flat, "NORMAL", normals)}),
        "NORMAL",
        [](const glm::vec4& value) { EXPECT_NEAR(glm::length(glm::vec3(value)), 1.0f, 1e-4f); });
}

TEST(Seams, TextureCoordinatesStayInsideTheirRange) {
    forEveryVertex(submeshOf({seamedSphere()}), "TEXCOORD_0", [](const glm::vec4& value) {
        EXPECT_TRUE(value.x >= -0.12f && value.x <= 0.87f) << value.x;
        EXPECT_TRUE(value.y >= -0.56f && value.y <= 0.56f) << value.y;
    });
}

TEST(Seams, TangentsKeepAUnitDirectionAndASign) {
    const GeometryPtr flat = meshes::sphere(8, 10);
    std::vector<float> tangents;
    for (const glm::vec3& p : flat->positions) {
        const glm::vec3 t = glm::normalize(glm::vec3(1.0f, p.z, p.y));
        tangents.insert(tangents.end(), {t.x, t.y, t.z, p.x > 0.0f ? 1.0f : -1.0f});
    }
    forEveryVertex(submeshOf({meshes::withAttribute(*flat, "TANGENT", tangents)}),
                   "TANGENT",
                   [](const glm::vec4& value) {
                       EXPECT_NEAR(glm::length(glm::vec3(value)), 1.0f, 1e-4f);
                       EXPECT_EQ(std::abs(value.w), 1.0f);
                   });
}

TEST(Seams, JointsAreOriginalOnesAndWeightsStillSumToOne) {
    const GeometryPtr skinned = skinnedGrid();
    std::set<std::array<float, 2>> pairs;
    const Attribute& joints = skinned->attributes[0];
    for (std::size_t v = 0; v < skinned->positions.size(); ++v)
        pairs.insert({attributeValue(joints, v, 0), attributeValue(joints, v, 1)});
    forEveryVertex(submeshOf({skinned}), "JOINTS_0", [&](const glm::vec4& value) {
        EXPECT_TRUE(pairs.contains({value.x, value.y})) << value.x << " " << value.y;
    });
    forEveryVertex(submeshOf({skinned}), "WEIGHTS_0", [](const glm::vec4& value) {
        EXPECT_NEAR(value.x + value.y + value.z + value.w, 1.0f, 1e-5f);
    });
}

TEST(Seams, MorphTargetsFollowTheirVertices) {
    auto geometry = std::make_shared<Geometry>(*meshes::grid(8));
    std::vector<float> deltas;
    for (const glm::vec3& p : geometry->positions)
        deltas.insert(deltas.end(), {0.0f, 0.0f, p.x});
    geometry->morph_targets.push_back(
        {meshes::withAttribute(*geometry, "POSITION", deltas)->attributes});
    const Submesh submesh = submeshOf({geometry});
    const CollapseSequence sequence = sequenceOf(submesh);
    const GeometryPtr last = readAt(sequence, submesh, sequence.step_count * 3 / 4)[0];
    ASSERT_EQ(last->morph_targets.size(), 1u);
    for (std::size_t v = 0; v < last->positions.size(); ++v)
        EXPECT_NEAR(
            attributeValue(last->morph_targets[0].attributes[0], v, 2), last->positions[v].x, 0.2f);
}

} // namespace lodestone
