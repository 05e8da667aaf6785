#include "tests/simplify/meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <gtest/gtest.h>
#include <map>
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

// A bowl whose left half shows the texture of the right one mirrored: along the seam between them
// places and texture coordinates agree, tangents and their signs do not.
GeometryPtr mirroredBowl() {
    constexpr std::uint32_t kSide = 10;
    auto bowl = std::make_shared<Geometry>();
    std::vector<float> texcoords;
    std::vector<float> tangents;
    for (const float side : {1.0f, -1.0f}) {
        const auto first = static_cast<std::uint32_t>(bowl->positions.size());
        for (std::uint32_t i = 0; i <= kSide; ++i)
            for (std::uint32_t j = 0; j <= kSide; ++j) {
                const glm::vec2 uv = glm::vec2(i, j) / static_cast<float>(kSide);
                const float x = side * uv.x;
                const glm::vec3 tangent = glm::normalize(glm::vec3(side, 0.0f, 0.8f * uv.x));
                bowl->positions.emplace_back(x, uv.y, 0.4f * x * x + 0.1f * uv.y * uv.y);
                texcoords.insert(texcoords.end(), {uv.x, uv.y});
                tangents.insert(tangents.end(), {tangent.x, tangent.y, tangent.z, side});
            }
        for (std::uint32_t i = 0; i < kSide; ++i)
            for (std::uint32_t j = 0; j < kSide; ++j) {
                const std::uint32_t a = first + i * (kSide + 1) + j;
                const std::uint32_t b = a + kSide + 1;
                const std::array<std::uint32_t, 6> right{a, b, b + 1, a, b + 1, a + 1};
                const std::array<std::uint32_t, 6> left{a, b + 1, b, a, a + 1, b + 1};
                const auto& quad = side > 0.0f ? right : left;
                bowl->indices.insert(bowl->indices.end(), quad.begin(), quad.end());
            }
    }
    return meshes::withAttribute(
        *meshes::withAttribute(*bowl, "TEXCOORD_0", texcoords), "TANGENT", tangents);
}

// A square of one colour of a palette beside one of another; its side is divided, the other's is
// not, and faces without area sew them together.
GeometryPtr sewnSquares() {
    constexpr std::uint32_t kSide = 4;
    auto squares = std::make_shared<Geometry>(*meshes::grid(kSide)); // x, y: 0..1
    std::vector<float> texcoords(2 * squares->positions.size(), 0.25f);
    const auto add = [&](float x, float y) {
        squares->positions.emplace_back(x, y, 0.0f);
        texcoords.insert(texcoords.end(), {0.75f, 0.75f});
        return static_cast<std::uint32_t>(squares->positions.size() - 1);
    };
    std::vector<std::uint32_t> side;
    for (std::uint32_t i = 0; i <= kSide; ++i)
        side.push_back(add(1.0f, static_cast<float>(i) / kSide));
    const std::uint32_t low = add(2.0f, 0.0f);
    const std::uint32_t high = add(2.0f, 1.0f);
    std::vector<std::uint32_t> indices{side[0], low, high, side[0], high, side[kSide]};
    for (std::uint32_t i = 2; i <= kSide; ++i) // no area
        indices.insert(indices.end(), {side[0], side[i], side[i - 1]});
    squares->indices.insert(squares->indices.begin(), indices.begin(), indices.end());
    return meshes::withAttribute(*squares, "TEXCOORD_0", texcoords);
}

// Twice the area of a face's triangle in its texture.
float texturedArea(const Geometry& geometry, std::size_t face) {
    const Attribute& texcoords = *findAttribute(geometry.attributes, "TEXCOORD_0");
    std::array<glm::vec2, 3> uv;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t vertex = geometry.indices[3 * face + k];
        uv[k] = {attributeValue(texcoords, vertex, 0), attributeValue(texcoords, vertex, 1)};
    }
    const glm::vec2 a = uv[1] - uv[0];
    const glm::vec2 b = uv[2] - uv[0];
    return a.x * b.y - a.y * b.x;
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

TEST(Seams, ColoursKeepTheirAreaAcrossFacesWithoutAny) {
    const Submesh submesh = submeshOf({sewnSquares()});
    const CollapseSequence sequence = sequenceOf(submesh);
    for (std::uint32_t step = 0; sequence.facesAt(step) > 8; ++step) {
        const GeometryPtr now = readAt(sequence, submesh, step)[0];
        const Attribute& texcoords = *findAttribute(now->attributes, "TEXCOORD_0");
        double area = 0.0;
        for (std::size_t i = 0; i < now->indices.size(); i += 3) {
            const glm::vec3 a = now->positions[now->indices[i]];
            const glm::vec3 b = now->positions[now->indices[i + 1]] - a;
            const glm::vec3 c = now->positions[now->indices[i + 2]] - a;
            if (attributeValue(texcoords, now->indices[i], 0) < 0.5f)
                area += 0.5 * glm::length(glm::cross(b, c));
        }
        ASSERT_NEAR(area, 1.0, 1e-3) << sequence.facesAt(step) << " faces";
    }
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

TEST(Seams, TangentsKeepTheirSignOnEitherSideOfAMirroredTexture) {
    constexpr float kFlat = 1e-5f; // of the texture's area: shows no side
    const Submesh submesh = submeshOf({mirroredBowl()});
    const CollapseSequence sequence = sequenceOf(submesh);
    for (std::uint32_t step = 0; sequence.facesAt(step) > 8; ++step) {
        const GeometryPtr now = readAt(sequence, submesh, step)[0];
        const Attribute& tangents = *findAttribute(now->attributes, "TANGENT");
        for (std::size_t face = 0; face < now->triangleCount(); ++face) {
            const float area = texturedArea(*now, face);
            for (std::size_t k = 0; k < 3 && std::abs(area) > kFlat; ++k)
                ASSERT_EQ(attributeValue(tangents, now->indices[3 * face + k], 3),
                          area > 0.0f ? 1.0f : -1.0f)
                    << "step " << step;
        }
    }
}

TEST(Seams, JointsAreThoseOfTheFileOnceEachAndWeightsStillSumToOne) {
    const Submesh submesh = submeshOf({skinnedGrid()});
    const CollapseSequence sequence = sequenceOf(submesh);
    for (std::uint32_t step = 0; step <= sequence.step_count; ++step) {
        const GeometryPtr now = readAt(sequence, submesh, step)[0];
        const Attribute& joints = *findAttribute(now->attributes, "JOINTS_0");
        const Attribute& weights = *findAttribute(now->attributes, "WEIGHTS_0");
        for (std::size_t v = 0; v < now->positions.size(); ++v) {
            std::set<float> used;
            float sum = 0.0f;
            for (std::size_t c = 0; c < 4; ++c) {
                const float weight = attributeValue(weights, v, c);
                sum += weight;
                EXPECT_LE(attributeValue(joints, v, c), 6.0f);
                if (weight > 0.0f) {
                    EXPECT_TRUE(used.insert(attributeValue(joints, v, c)).second);
                }
            }
            ASSERT_NEAR(sum, 1.0f, 1e-5f) << "step " << step;
        }
    }
}

TEST(Seams, WeightsOfBytesSumToOneToTheLastBit) {
    auto geometry = std::make_shared<Geometry>(*skinnedGrid());
    Attribute& weights = geometry->attributes[1];
    Attribute bytes{"WEIGHTS_0", ComponentType::UInt8, 4, true, {}};
    for (std::size_t v = 0; v < geometry->positions.size(); ++v) {
        const auto first = static_cast<int>(std::lround(255.0f * attributeValue(weights, v, 0)));
        for (const int weight : {first, 255 - first, 0, 0})
            bytes.bytes.push_back(static_cast<std::byte>(weight));
    }
    weights = bytes;
    const Submesh submesh = submeshOf({geometry});
    const CollapseSequence sequence = sequenceOf(submesh);
    for (std::uint32_t step = 0; step <= sequence.step_count; ++step) {
        const GeometryPtr now = readAt(sequence, submesh, step)[0];
        const Attribute& now_weights = *findAttribute(now->attributes, "WEIGHTS_0");
        for (std::size_t v = 0; v < now->positions.size(); ++v) {
            int sum = 0;
            for (std::size_t c = 0; c < 4; ++c)
                sum += std::to_integer<int>(now_weights.bytes[4 * v + c]);
            ASSERT_EQ(sum, 255) << "step " << step;
        }
    }
}

TEST(Seams, BlendedInfluencesKeepTheStrongest) {
    const WedgeAttributes::SkinSet set{0, 4};
    std::array<float, 8> a{1, 2, 3, 4, 0.4f, 0.3f, 0.2f, 0.1f};
    const std::array<float, 8> b{5, 2, 0, 0, 0.8f, 0.2f, 0.0f, 0.0f};
    blendSkin(a.data(), b.data(), 0.5f, std::span(&set, 1));
    // 5: 0.4, 2: 0.25, 1: 0.2, 3: 0.1 of 0.95; 4 is the weakest.
    const std::array<float, 8> expected{
        5, 2, 1, 3, 0.4f / 0.95f, 0.25f / 0.95f, 0.2f / 0.95f, 0.1f / 0.95f};
    for (std::size_t i = 0; i < a.size(); ++i)
        EXPECT_NEAR(a[i], expected[i], 1e-6f) << i;
}

// A flat sheet of which a morph target lifts a narrow ridge: nothing at rest shows it.
TEST(Seams, MotionOfMorphTargetsIsKeptWhereTheRestPoseIsFlat) {
    auto geometry = std::make_shared<Geometry>(*meshes::grid(24));
    std::vector<float> deltas;
    const auto lift = [](float x) { return 0.2f * std::exp(-100.0f * (x - 0.5f) * (x - 0.5f)); };
    for (const glm::vec3& p : geometry->positions)
        deltas.insert(deltas.end(), {0.0f, 0.0f, lift(p.x)});
    geometry->morph_targets.push_back(
        {meshes::withAttribute(*geometry, "POSITION", deltas)->attributes});
    const Submesh submesh = submeshOf({geometry});
    const auto highest = [&](double weight) {
        CollapseOptions options;
        options.attributes.motion = weight;
        const CollapseSequence sequence = sequenceOf(submesh, options);
        std::uint32_t step = 0;
        while (sequence.facesAt(step) > 80)
            ++step;
        const GeometryPtr now = readAt(sequence, submesh, step)[0];
        float top = 0.0f;
        for (std::size_t v = 0; v < now->positions.size(); ++v)
            top = std::max(top, attributeValue(now->morph_targets[0].attributes[0], v, 2));
        return top;
    };
    EXPECT_GT(highest(1.0), 0.19f);
    EXPECT_LT(highest(0.0), 0.19f);
}

TEST(Seams, StrictKeepsEveryJunctionOfSeams) {
    const Submesh submesh = submeshOf({seamedSphere()});
    CollapseOptions strict;
    strict.seams = 0.0;
    const CollapseSequence kept = sequenceOf(submesh, strict);
    // Places where more than two charts meet: two, at the poles of the cut.
    const auto junctions = [&](const CollapseSequence& sequence, std::uint32_t step) {
        std::map<std::array<float, 3>, int> wedges;
        for (std::uint32_t w = 0; w < sequence.wedge_death.size(); ++w)
            if (sequence.wedge_death[w] > step) {
                const glm::vec3 p = wedgePosition(sequence, submesh, w, step);
                ++wedges[{p.x, p.y, p.z}];
            }
        return std::ranges::count_if(wedges, [](const auto& place) { return place.second > 2; });
    };
    const auto at_first = junctions(kept, 0);
    EXPECT_GE(at_first, 2);
    for (std::uint32_t step = 0; step <= kept.step_count; step += 5)
        ASSERT_EQ(junctions(kept, step), at_first) << "step " << step;
}

TEST(Seams, TargetMissedForStrictSeamsIsSaidWithTheirShare) {
    const ScenePtr scene = meshes::sceneOf({submeshOf({facetedSphere()})}, {{glm::dmat4(1.0)}});
    EdgeCollapseOptions options;
    options.collapse.seams = 0.0;
    const LodSourcePtr source = prepareEdgeCollapse(scene, options, {}, {}).value();
    const Resolved resolved =
        source->resolve({Target::Kind::Ratio, 0.1}, ByteModel(source->scene(), {}));
    EXPECT_FALSE(resolved.met);
    EXPECT_NE(resolved.note.find("100 % of remaining vertices lie on seams"), std::string::npos)
        << resolved.note;
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
