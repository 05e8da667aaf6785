// Our distances beside those of CGAL: its sampler, its search tree, its enclosed maximum.
#include "scene/generate.h"
#include "scene/import.h"
#include "simplify/algorithm.h"
#include "simplify/measure/distance.h"
#include "simplify/measure/surface.h"
#include "tests/models_folder.h"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/distance.h>
#include <CGAL/Surface_mesh.h>
#include <algorithm>
#include <cmath>

using namespace lodestone;
using lodestone::tests::modelsFolder;

namespace {

namespace pmp = CGAL::Polygon_mesh_processing;

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;
using AabbTree =
    CGAL::AABB_tree<CGAL::AABB_traits<Kernel, CGAL::AABB_face_graph_triangle_primitive<Mesh>>>;

constexpr double kTolerance = 0.02;

// All instances in world space, every triangle with corners of its own: any topology will do.
Mesh meshOf(const LodView& view) {
    Mesh mesh;
    for (const SurfacePiece& piece : surfacePieces(view, SurfaceFrame{}))
        for (std::size_t t = 0; t < piece.geometry->triangleCount(); ++t) {
            const Triangle triangle = piece.triangle(t);
            const auto add = [&](const glm::dvec3& p) {
                return mesh.add_vertex(Point(p.x, p.y, p.z));
            };
            if (areaOf(triangle) > 0.0)
                mesh.add_face(add(triangle[0]), add(triangle[1]), add(triangle[2]));
        }
    return mesh;
}

struct OneSided {
    double mean = 0.0;
    double rms = 0.0;
    double max = 0.0; // of the samples
};

OneSided sampled(const Mesh& from, const Mesh& to) {
    constexpr unsigned kSamples = 200'000;
    std::vector<Point> points;
    pmp::sample_triangle_mesh(from,
                              std::back_inserter(points),
                              CGAL::parameters::random_seed(1)
                                  .use_random_uniform_sampling(true)
                                  .number_of_points_on_faces(kSamples)
                                  .do_sample_vertices(false)
                                  .do_sample_edges(false));
    AabbTree tree(faces(to).begin(), faces(to).end(), to);
    tree.build();
    tree.accelerate_distance_queries();
    OneSided result;
    for (const Point& point : points) {
        const double distance2 = tree.squared_distance(point);
        result.mean += std::sqrt(distance2);
        result.rms += distance2;
        result.max = std::max(result.max, std::sqrt(distance2));
    }
    result.mean /= static_cast<double>(points.size());
    result.rms = std::sqrt(result.rms / static_cast<double>(points.size()));
    return result;
}

struct Pair {
    ScenePtr original;
    ScenePtr scene; // whose LOD it is
    Lod lod;
};

class IndependentDistance : public lodestone::tests::ModelsTest {
protected:
    static Pair simplified(const ScenePtr& original, const char* algorithm, double ratio) {
        const auto source = findAlgorithm(algorithm)->prepare(original, {}, {}, {});
        EXPECT_TRUE(source);
        const ByteModel bytes((*source)->scene(), {});
        const Resolved at = (*source)->resolve({Target::Kind::Ratio, ratio}, bytes);
        return {original, (*source)->scene(), (*source)->readOut(at.position, nullptr)};
    }

    static ScenePtr model(const char* path) {
        const Result<ScenePtr> scene = importScene(modelsFolder() / path, {});
        EXPECT_TRUE(scene) << path;
        return scene.value_or(nullptr);
    }

    static void expectEqualMeasures(const Pair& pair, const char* name) {
        const Lod full = fullLod(*pair.original);
        const LodView a{pair.original.get(), &full};
        const LodView b{pair.scene.get(), &pair.lod};
        const Result<Distance> ours = measureDistance(a, b, {}, {});
        ASSERT_TRUE(ours) << name;
        const Mesh mesh_a = meshOf(a);
        const Mesh mesh_b = meshOf(b);
        const OneSided there = sampled(mesh_a, mesh_b);
        const OneSided back = sampled(mesh_b, mesh_a);
        const double percent = 100.0 / robustWorldBounds(*pair.original).diagonal();
        const double mean = percent * 0.5 * (there.mean + back.mean);
        const double rms = percent * std::max(there.rms, back.rms);
        // Asked as closely as ours is claimed to be enclosed.
        const double bound = 0.005 * ours->hausdorff / percent;
        const double max =
            percent * pmp::bounded_error_symmetric_Hausdorff_distance<CGAL::Sequential_tag>(
                          mesh_a, mesh_b, bound);
        EXPECT_NEAR(ours->mean, mean, kTolerance * mean) << name;
        EXPECT_NEAR(ours->rms, rms, kTolerance * rms) << name;
        EXPECT_NEAR(ours->hausdorff, max, kTolerance * max) << name;
        EXPECT_GE(ours->hausdorff, percent * std::max(there.max, back.max) * 0.999) << name;
        RecordProperty(name,
                       "max " + std::to_string(ours->hausdorff) + " / " + std::to_string(max) +
                           ", mean " + std::to_string(ours->mean) + " / " + std::to_string(mean) +
                           ", rms " + std::to_string(ours->rms) + " / " + std::to_string(rms));
    }
};

} // namespace

TEST_F(IndependentDistance, AgreesOnTheBunny) {
    const ScenePtr bunny = model("meshes/bun_zipper/bun_zipper.ply");
    ASSERT_TRUE(bunny);
    expectEqualMeasures(simplified(bunny, "quadric", 0.2), "bunny at 20 %");
    expectEqualMeasures(simplified(bunny, "quadric", 0.01), "bunny at 1 %");
}

TEST_F(IndependentDistance, AgreesOnATexturedModel) {
    const ScenePtr helmet = model("textured/DamagedHelmet/DamagedHelmet.glb");
    ASSERT_TRUE(helmet);
    expectEqualMeasures(simplified(helmet, "ias", 0.1), "helmet at 10 %");
}

TEST_F(IndependentDistance, AgreesOnAnInstancedScene) {
    const Result<ScenePtr> chair = generateScene("chair");
    ASSERT_TRUE(chair);
    expectEqualMeasures(simplified(*chair, "ias", 0.2), "chair at 20 %");
}
