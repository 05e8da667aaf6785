#include "scene/scene_builder.h"
#include "simplify/algorithm.h"
#include "simplify/bake/atlas.h"
#include "simplify/bake/bake.h"
#include "simplify/bake/successive_map.h"
#include "simplify/bake/texture_sampler.h"
#include "simplify/measure/color_distance.h"
#include "simplify/measure/surface_color.h"
#include "simplify/measure/triangle.h"
#include "simplify/wild/wild.h"
#include "tests/png_image.h"
#include "tests/simplify/meshes.h"

#include <atomic>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

using namespace lodestone;
using namespace lodestone::meshes;

namespace {

constexpr std::array<std::uint8_t, 3> kMagenta{255, 0, 255};

// Columns of green and blue; magenta elsewhere would show.
Image stripes() {
    constexpr int kSize = 64;
    std::vector<std::uint8_t> rgb;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            const bool green = x / 8 % 2 == 0;
            rgb.insert(rgb.end(),
                       {0,
                        static_cast<std::uint8_t>(green ? 200 : 0),
                        static_cast<std::uint8_t>(green ? 0 : 200)});
        }
    return pngImage("stripes", kSize, kSize, rgb);
}

// A bumpy sphere whose triangles have texture islands of their own, as far as coordinates go.
ScenePtr stripedSphere() {
    const GeometryPtr round = sphere(24, 32);
    Geometry apart;
    std::vector<float> uv;
    for (std::size_t i = 0; i < round->indices.size(); ++i) {
        const glm::vec3 p = round->positions[round->indices[i]];
        apart.positions.push_back(p);
        apart.indices.push_back(static_cast<std::uint32_t>(i));
        const std::size_t island = i / 3 % 4; // neighbours lie apart in the texture
        uv.push_back(0.5f + 0.2f * p.x + static_cast<float>(island));
        uv.push_back(0.5f + 0.2f * p.y);
    }
    SceneBuilder builder("striped");
    const std::uint32_t image = builder.addImage(stripes());
    Material material;
    material.name = "stripes";
    material.base_color_texture.image = image;
    Primitive primitive;
    primitive.material = builder.addMaterial(material);
    primitive.geometry = withAttribute(apart, "TEXCOORD_0", uv);
    const std::uint32_t submesh = builder.addSubmesh({"sphere", {primitive}});
    builder.addNode("left", kNone, Trs{}, submesh);
    builder.addNode("right", kNone, Trs{{5.0, 0.0, 0.0}}, submesh);
    return builder.finish();
}

struct Transferred {
    LodSourcePtr source;
    Lod lod;
    Result<BakedScene> baked;
};

// A flat sheet that repeats a picture more often than an atlas of 512 pixels has texels for.
ScenePtr tiledSheet() {
    const GeometryPtr flat = grid(12);
    std::vector<float> uv;
    for (const glm::vec3& p : flat->positions)
        uv.insert(uv.end(), {20.0f * p.x, 20.0f * p.y});
    SceneBuilder builder("tiled");
    Material material;
    material.name = "tiles";
    material.base_color_texture.image = builder.addImage(stripes());
    Primitive primitive;
    primitive.material = builder.addMaterial(material);
    primitive.geometry = withAttribute(*flat, "TEXCOORD_0", uv);
    builder.addNode("sheet", kNone, Trs{}, builder.addSubmesh({"sheet", {primitive}}));
    return builder.finish();
}

Transferred transfer(const ScenePtr& scene,
                     double ratio,
                     const JobContext& job = {},
                     const BakeOptions& asked = {}) {
    const ParameterValues values{{"floors", 0.0}};
    Transferred result{*wildAlgorithm().prepare(scene, values, {}, {}), {}, {}};
    const ByteModel bytes(result.source->scene(), {});
    result.lod = result.source->readOut(
        result.source->resolve({Target::Kind::Ratio, ratio}, bytes).position, nullptr);
    BakeOptions options = asked;
    options.atlas_px = 512;
    result.baked = result.source->transferred(result.lod, options, job);
    return result;
}

} // namespace

TEST(Atlas, NoTexelIsVisitedForTwoTriangles) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> length(0.0, 1.0);
    std::vector<FlatTriangle> triangles(301);
    for (FlatTriangle& triangle : triangles) {
        triangle.base = 0.01 + length(random);
        triangle.height = triangle.base * length(random) * length(random);
    }
    const Result<Atlas> atlas = packAtlas(triangles, 512);
    ASSERT_TRUE(atlas);
    EXPECT_GT(atlas->texels_per_unit, 10.0);
    std::vector<int> owner(512 * 512, -1);
    for (int i = 0; i < 301; ++i)
        forEachTexel(atlas->places[static_cast<std::size_t>(i)],
                     [&](std::uint32_t x, std::uint32_t y, double u, double v) {
                         ASSERT_LT(x, 512u);
                         ASSERT_LT(y, 512u);
                         EXPECT_GE(std::min({u, v, 1.0 - u - v}), -1e-9);
                         int& at = owner[y * 512 + x];
                         EXPECT_EQ(at, -1);
                         at = i;
                     });
}

TEST(Atlas, BilinearFilteringStaysInsideTheTriangle) {
    const std::vector<FlatTriangle> triangles{{1.0, 0.7}, {1.0, 0.02}, {0.3, 0.3}, {0.3, 0.1}};
    const Result<Atlas> atlas = packAtlas(triangles, 256);
    ASSERT_TRUE(atlas);
    std::vector<int> owner(256 * 256, -1);
    for (int i = 0; i < 4; ++i)
        forEachTexel(
            atlas->places[static_cast<std::size_t>(i)],
            [&](std::uint32_t x, std::uint32_t y, double, double) { owner[y * 256 + x] = i; });
    for (int i = 0; i < 4; ++i)
        for (int a = 0; a <= 50; ++a)
            for (int b = 0; a + b <= 50; ++b) {
                const glm::dvec2 at =
                    atlas->places[static_cast<std::size_t>(i)].at(a / 50.0, b / 50.0) - 0.5;
                for (int dy = 0; dy < 2; ++dy)
                    for (int dx = 0; dx < 2; ++dx) {
                        const double wx = dx ? at.x - std::floor(at.x) : 1.0;
                        const double wy = dy ? at.y - std::floor(at.y) : 1.0;
                        if (wx < 1e-6 || wy < 1e-6)
                            continue;
                        const auto x = static_cast<std::size_t>(std::floor(at.x)) +
                                       static_cast<std::size_t>(dx);
                        const auto y = static_cast<std::size_t>(std::floor(at.y)) +
                                       static_cast<std::size_t>(dy);
                        ASSERT_EQ(owner[y * 256 + x], i);
                    }
            }
}

TEST(Atlas, SaysWhichSizeWouldBeEnough) {
    const std::vector<FlatTriangle> triangles(20'000, FlatTriangle{1.0, 1.0});
    const Result<Atlas> atlas = packAtlas(triangles, 256);
    ASSERT_FALSE(atlas);
    EXPECT_EQ(atlas.error().kind, ErrorKind::Usage);
    EXPECT_NE(atlas.error().message.find("use 1024 or more"), std::string::npos)
        << atlas.error().message;
    EXPECT_TRUE(packAtlas(triangles, 1024));
}

TEST(SuccessiveMap, IsTheIdentityBeforeAnyCollapse) {
    const Submesh submesh = submeshOf({grid(6)});
    const CollapseSequence sequence = sequenceOf(submesh);
    const SuccessiveMap map(sequence, submesh, 0, {});
    for (const std::uint32_t face : map.facesOf(0)) {
        const auto corners = map.triangle(face);
        const glm::vec3 point = corners[0] * 0.2f + corners[1] * 0.3f + corners[2] * 0.5f;
        const SuccessiveMap::Hit hit = map.trace(face, point, {0.0f, 0.0f, 1.0f});
        EXPECT_EQ(hit.face, face);
        EXPECT_NEAR(hit.weights.x, 0.2f, 1e-5f);
        EXPECT_NEAR(hit.weights.z, 0.5f, 1e-5f);
    }
}

TEST(SuccessiveMap, LeadsToTheSamePlaceOnAFlatSheet) {
    const Submesh submesh = submeshOf({grid(12)});
    const CollapseSequence sequence = sequenceOf(submesh);
    const std::uint32_t last = sequence.step_count;
    ASSERT_GT(last, 100u);
    const SuccessiveMap map(sequence, submesh, last, {});
    const Geometry& from = *submesh.primitives[0].geometry;
    for (const std::uint32_t face : map.facesOf(0))
        for (int i = 1; i < 10; ++i) {
            const auto corners = map.triangle(face);
            const float share = static_cast<float>(i) / 10.0f;
            const glm::vec3 point =
                corners[0] * share * 0.5f + corners[1] * share * 0.5f + corners[2] * (1.0f - share);
            const SuccessiveMap::Hit hit = map.trace(face, point, {0.0f, 0.0f, 1.0f});
            glm::vec3 reached(0.0f);
            for (std::size_t k = 0; k < 3; ++k)
                reached += hit.weights[static_cast<int>(k)] *
                           from.positions[sequence.complex
                                              .wedge_source[sequence.complex.faces[hit.face][k]]];
            EXPECT_LT(glm::length(reached - point), 1e-4f);
        }
}

TEST(SuccessiveMap, StaysOnItsSideOfAThinSlab) {
    // Two sheets much closer to each other than their triangles are large, one slightly bent.
    const GeometryPtr below = grid(10);
    const Submesh submesh = submeshOf({moved(below, {0.0, 0.0, 2e-3}), below});
    const CollapseSequence sequence = sequenceOf(submesh);
    const SuccessiveMap map(sequence, submesh, sequence.step_count, {});
    for (std::size_t p = 0; p < 2; ++p)
        for (const std::uint32_t face : map.facesOf(p)) {
            const auto corners = map.triangle(face);
            glm::vec3 point = (corners[0] + corners[1] + corners[2]) / 3.0f;
            point.z = 1e-3f; // half way between both
            const SuccessiveMap::Hit hit = map.trace(face, point, {0.0f, 0.0f, 1.0f});
            EXPECT_EQ(sequence.complex.primitiveOfFace(hit.face), p);
        }
}

TEST(SuccessiveMap, LeadsToTheNearestOfTheFacesThatLookTheSameWay) {
    const Submesh submesh = submeshOf({sphere(24, 32)});
    const Geometry& original = *submesh.primitives[0].geometry;
    const CollapseSequence sequence = sequenceOf(submesh);
    const std::uint32_t step = sequence.step_count * 9 / 10; // finer splits are left to the search
    const SuccessiveMap map(sequence, submesh, step, {});
    const auto cornersAt = [&](std::size_t face) {
        Triangle t;
        for (std::size_t k = 0; k < 3; ++k)
            t[k] = glm::dvec3(original.positions[original.indices[3 * face + k]]);
        return t;
    };
    ASSERT_FALSE(map.facesOf(0).empty());
    for (const std::uint32_t face : map.facesOf(0)) {
        const auto c = map.triangle(face);
        const glm::vec3 normal = glm::cross(c[1] - c[0], c[2] - c[0]);
        const glm::vec3 point = 0.5f * c[0] + 0.3f * c[1] + 0.2f * c[2];
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t f = 0; f < original.triangleCount(); ++f) {
            const Triangle t = cornersAt(f);
            if (glm::dot(glm::cross(t[1] - t[0], t[2] - t[0]), glm::dvec3(normal)) > 0.0)
                least = std::min(least, std::sqrt(squaredDistance(glm::dvec3(point), t)));
        }
        const SuccessiveMap::Hit hit = map.trace(face, point, normal);
        const Triangle t = cornersAt(hit.face);
        const glm::dvec3 w(hit.weights);
        const glm::dvec3 on = t[0] * w.x + t[1] * w.y + t[2] * w.z;
        EXPECT_NEAR(glm::length(on - glm::dvec3(point)), least, 1e-5);
    }
}

TEST(Bake, ShowsTheColoursOfTheSurfaceWhereTextureCoordinatesWouldBleed) {
    const ScenePtr scene = stripedSphere();
    const Transferred transferred = transfer(scene, 0.1);
    ASSERT_TRUE(transferred.baked) << transferred.baked.error().message;
    const Scene& baked = *transferred.baked->scene;
    EXPECT_EQ(countScene(baked).triangles, transferred.lod.triangles);
    EXPECT_EQ(baked.instances.size(), 2u);
    EXPECT_GT(transferred.baked->texels_per_unit, 10.0);
    const Lod full = fullLod(*scene);
    const Lod all = fullLod(baked);
    const auto kept = measureColorDistance({scene.get(), &full},
                                           {transferred.source->scene().get(), &transferred.lod},
                                           {20'000, 1},
                                           {});
    const auto moved = measureColorDistance({scene.get(), &full}, {&baked, &all}, {20'000, 1}, {});
    ASSERT_TRUE(kept && moved);
    EXPECT_LT(moved->mean, 0.4 * kept->mean);
}

TEST(Bake, MaterialsKeepTexturesThatStillShowTheOriginalOnlyWhereAsked) {
    const ScenePtr scene = tiledSheet();
    BakeOptions keep;
    keep.keep_better = true;
    const Transferred kept = transfer(scene, 1.0, {}, keep);
    ASSERT_TRUE(kept.baked) << kept.baked.error().message;
    EXPECT_TRUE(kept.baked->atlases.empty());
    EXPECT_EQ(kept.baked->texels_per_unit, 0.0);
    ASSERT_EQ(kept.baked->notes.size(), 1u);
    EXPECT_NE(kept.baked->notes[0].find("'tiles' keeps its textures"), std::string::npos);
    ASSERT_EQ(kept.baked->scene->images.size(), 1u);
    EXPECT_EQ(kept.baked->scene->images[0].bytes, scene->images[0].bytes);
    const Lod full = fullLod(*scene);
    const Lod all = fullLod(*kept.baked->scene);
    const auto apart = measureColorDistance(
        {scene.get(), &full}, {kept.baked->scene.get(), &all}, {20'000, 1}, {});
    ASSERT_TRUE(apart);
    EXPECT_LT(apart->mean, 0.01);
    const Transferred moved = transfer(scene, 1.0);
    ASSERT_TRUE(moved.baked);
    EXPECT_EQ(moved.baked->atlases.size(), 1u);
}

TEST(Bake, MaterialsWhoseCoordinatesBleedGetAnAtlasEvenThen) {
    BakeOptions keep;
    keep.keep_better = true;
    const Transferred moved = transfer(stripedSphere(), 0.1, {}, keep);
    ASSERT_TRUE(moved.baked) << moved.baked.error().message;
    EXPECT_EQ(moved.baked->atlases.size(), 1u);
    EXPECT_TRUE(moved.baked->notes.empty());
}

TEST(Bake, UnusedTexelsNeverReachTheSurface) {
    const ScenePtr scene = stripedSphere();
    const Submesh& submesh = scene->submeshes[0];
    const CollapseSequence sequence = sequenceOf(submesh);
    const std::uint32_t step = sequence.step_count / 2;
    Lod lod = fullLod(*scene);
    lod.submeshes[0].primitives = readAt(sequence, submesh, step);
    const BakeSubmesh at{&sequence, step};
    BakeOptions options;
    options.atlas_px = 512;
    options.unused = kMagenta;
    const Result<BakedScene> baked = bakeTextures(*scene, lod, std::span(&at, 1), options, {});
    ASSERT_TRUE(baked) << baked.error().message;
    const DecodedImage atlas = decodeImage(baked->scene->images[0], 512);
    ASSERT_TRUE(atlas.rgba);
    int unused = 0;
    for (std::size_t i = 0; i < std::size_t{512} * 512; ++i)
        unused += std::equal(kMagenta.begin(), kMagenta.end(), atlas.rgba.get() + 4 * i);
    ASSERT_GT(unused, 1000); // there is something that could show
    const SurfaceColors colors(*baked->scene);
    const Primitive& primitive = baked->scene->submeshes[0].primitives[0];
    std::mt19937 random(11);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    for (std::size_t t = 0; t < primitive.geometry->triangleCount(); ++t)
        for (int i = 0; i < 40; ++i) {
            double u = share(random);
            double v = i % 4 == 0 ? 0.0 : share(random); // edges, too
            if (u + v > 1.0) {
                u = 1.0 - u;
                v = 1.0 - v;
            }
            const glm::dvec3 rgb =
                colors.at(*primitive.geometry, primitive.material, t, {1.0 - u - v, u, v});
            ASSERT_LT(rgb.r, 0.02) << "triangle " << t; // no red on the surface
        }
}

TEST(Bake, CancelsAndReports) {
    std::stop_source stop;
    stop.request_stop();
    JobContext job;
    job.stop = stop.get_token();
    const Transferred cancelled = transfer(stripedSphere(), 0.2, job);
    ASSERT_FALSE(cancelled.baked);
    EXPECT_EQ(cancelled.baked.error().kind, ErrorKind::Cancelled);
    std::atomic<double> most{0.0};
    JobContext reporting;
    reporting.progress = [&](double share) {
        if (share > most)
            most = share;
    };
    ASSERT_TRUE(transfer(stripedSphere(), 0.2, reporting).baked);
    EXPECT_NEAR(most, 1.0, 1e-9);
}

TEST(Bake, KeepsTheLookOfNormalMapsInTheNewFrame) {
    // A flat sheet whose normals lean along x; unfolded triangles are turned every way.
    const GeometryPtr flat = grid(4);
    const float lean = std::sqrt(0.5f);
    std::vector<float> normals;
    std::vector<float> uv;
    for (const glm::vec3& p : flat->positions) {
        normals.insert(normals.end(), {0.0f, 0.0f, 1.0f});
        uv.insert(uv.end(), {p.x, 1.0f - p.y}); // v runs down
    }
    const std::array<std::uint8_t, 3> texel{
        static_cast<std::uint8_t>(std::lround(127.5f + 127.5f * lean)),
        128,
        static_cast<std::uint8_t>(std::lround(127.5f + 127.5f * lean))};
    SceneBuilder builder("lean");
    Material material;
    material.normal_texture.image = builder.addImage(pngImage("lean", 1, 1, texel));
    Primitive primitive;
    primitive.material = builder.addMaterial(material);
    primitive.geometry = withAttribute(*withAttribute(*flat, "NORMAL", normals), "TEXCOORD_0", uv);
    const std::uint32_t submesh = builder.addSubmesh({"sheet", {primitive}});
    builder.addNode("sheet", kNone, Trs{}, submesh);
    const ScenePtr scene = builder.finish();
    const Transferred transferred = transfer(scene, 0.3);
    ASSERT_TRUE(transferred.baked) << transferred.baked.error().message;
    const Scene& baked = *transferred.baked->scene;
    const TextureSampler sampler(baked);
    const Primitive& out = baked.submeshes[0].primitives[0];
    for (std::uint32_t t = 0; t < out.geometry->triangleCount(); ++t) {
        const SurfaceLook look = sampler.at(
            *out.geometry, out.material, {3 * t, 3 * t + 1, 3 * t + 2}, glm::vec3(1.0f / 3.0f));
        EXPECT_NEAR(look.normal.x, lean, 0.02f);
        EXPECT_NEAR(look.normal.y, 0.0f, 0.02f);
        EXPECT_NEAR(look.normal.z, lean, 0.02f);
    }
}
