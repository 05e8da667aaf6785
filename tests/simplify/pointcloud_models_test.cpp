// The six methods over every real model: what must hold whatever comes in.
#include "scene/finite.h"
#include "scene/import.h"
#include "simplify/pointcloud/cloud_submesh.h"
#include "tests/models_folder.h"

#include <algorithm>
#include <cmath>
#include <set>

using namespace lodestone;
using lodestone::tests::modelFiles;

namespace {

class PointCloudModels : public lodestone::tests::ModelsTest {};

constexpr std::uint32_t kLargest = 100'000; // triangles of a submesh: larger ones take too long

constexpr std::array kMethods{&kVertexTriplexMethod,
                              &kFaceAngleMethod,
                              &kIntervertexDistanceMethod,
                              &kSphericalScanningMethod,
                              &kVertexTriplexDistanceMethod,
                              &kFaceAngleScanningMethod};

using Corner = std::array<float, 3>;

struct Edges {
    std::uint64_t single = 0;   // in one face
    std::uint64_t oriented = 0; // not as often one way as the other
};

Corner cornerOf(const Geometry& geometry, std::size_t index) {
    const glm::vec3& p = geometry.positions[geometry.indices[index]];
    return {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f};
}

Edges countEdges(const CloudPiece& piece) {
    std::vector<std::array<Corner, 2>> all;
    for (const GeometryPtr& geometry : piece.primitives)
        for (std::size_t i = 0; i + 2 < geometry->indices.size(); i += 3)
            for (std::size_t k = 0; k < 3; ++k) {
                std::array<Corner, 2> edge{cornerOf(*geometry, i + k),
                                           cornerOf(*geometry, i + (k + 1) % 3)};
                all.push_back(edge);
            }
    std::ranges::sort(all);
    Edges edges;
    for (std::size_t i = 0; i < all.size();) {
        std::size_t end = i;
        while (end < all.size() && all[end] == all[i])
            ++end;
        const std::array<Corner, 2> back{all[i][1], all[i][0]};
        const auto [low, high] = std::ranges::equal_range(all, back);
        const auto there = end - i;
        const auto returning = static_cast<std::size_t>(high - low);
        edges.single += there + returning == 1;
        edges.oriented += there != returning;
        i = end;
    }
    return edges;
}

void expectSound(const CloudSubmesh& cloud, const CloudPiece& piece) {
    EXPECT_LE(piece.triangles, cloud.triangles);
    EXPECT_TRUE(std::isfinite(piece.error));
    std::uint64_t triangles = 0;
    for (std::size_t p = 0; p < piece.primitives.size(); ++p) {
        const Geometry& geometry = *piece.primitives[p];
        if (cloud.submesh->primitives[p].mode != PrimitiveMode::Triangles)
            continue;
        triangles += geometry.triangleCount();
        for (const glm::vec3& v : geometry.positions)
            ASSERT_TRUE(isFinite(v));
        for (const std::uint32_t index : geometry.indices)
            ASSERT_LT(index, geometry.positions.size());
        for (const Attribute& attribute : geometry.attributes)
            ASSERT_EQ(attribute.bytes.size(), geometry.positions.size() * attribute.stride());
        if (!piece.changed)
            continue;
        std::set<std::array<Corner, 3>> seen; // places: seams hide neither doubles nor needles
        for (std::size_t i = 0; i < geometry.indices.size(); i += 3) {
            std::array<Corner, 3> face{
                cornerOf(geometry, i), cornerOf(geometry, i + 1), cornerOf(geometry, i + 2)};
            ASSERT_TRUE(face[0] != face[1] && face[1] != face[2] && face[0] != face[2]);
            std::rotate(face.begin(), std::ranges::min_element(face), face.end());
            ASSERT_TRUE(seen.insert(face).second);
        }
    }
    EXPECT_EQ(triangles, piece.triangles);
}

bool sameGeometry(const CloudPiece& a, const CloudPiece& b) {
    return std::ranges::equal(a.primitives, b.primitives, [](const auto& x, const auto& y) {
        return x->positions == y->positions && x->indices == y->indices;
    });
}

void expectIdentityAtZero(const CloudSubmesh& cloud) {
    for (const CloudMethod* method : kMethods) {
        const CloudPiece piece = simplifyPiece(cloud, *method, {}, {});
        EXPECT_FALSE(piece.changed) << method->main_id;
        EXPECT_EQ(piece.triangles, cloud.triangles) << method->main_id;
    }
}

void checkSubmesh(const CloudSubmesh& cloud) {
    const Bounds bounds = localBounds(*cloud.submesh);
    const Edges input = countEdges(finishPiece(cloud, originalDraft(cloud), {}));
    const bool closed = input.single == 0 && input.oriented == 0;
    for (const CloudMethod* method : kMethods) {
        const bool distance = method->main == MainParameter::DistancePct;
        double previous = cloud.triangles;
        for (const double share : {0.02, 0.1, 0.3}) {
            SCOPED_TRACE(std::string(method->main_id) + " " + std::to_string(share));
            CloudSettings settings;
            settings.main = distance ? share * bounds.diagonal() : share * method->maximum;
            const CloudPiece piece = simplifyPiece(cloud, *method, settings, {});
            expectSound(cloud, piece);
            // A few triangles more or less are no trend.
            if (cloud.triangles >= 1'000) {
                EXPECT_LE(piece.triangles, previous + 0.03 * cloud.triangles);
            }
            previous = std::min<double>(previous, piece.triangles);
            if (closed) {
                EXPECT_EQ(countEdges(piece).single, 0u);
            }
            if (cloud.triangles < 5'000) {
                EXPECT_TRUE(sameGeometry(piece, simplifyPiece(cloud, *method, settings, {})));
            }
        }
    }
}

} // namespace

TEST_F(PointCloudModels, EverySubmeshOfEveryModelComesOutSound) {
    int submeshes = 0;
    for (const std::filesystem::path& file : modelFiles()) {
        const Result<ScenePtr> scene = importScene(file, {});
        if (!scene)
            continue;
        const std::vector<InstanceRange> ranges = instanceRanges(**scene);
        for (std::size_t s = 0; s < ranges.size(); ++s) {
            const std::span<const Instance> instances((*scene)->instances);
            const CloudSubmesh cloud = makeCloudSubmesh(
                (*scene)->submeshes[s], instances.subspan(ranges[s].begin, ranges[s].size()), {});
            if (cloud.surface.faces.empty() || cloud.triangles > kLargest)
                continue;
            SCOPED_TRACE(file.filename().string() + " submesh " + std::to_string(s));
            expectIdentityAtZero(cloud);
            checkSubmesh(cloud);
            ++submeshes;
        }
    }
    EXPECT_GT(submeshes, 200);
}
