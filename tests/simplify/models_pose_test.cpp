#include "scene/pose.h"
#include "simplify/algorithm.h"
#include "tests/models_folder.h"

#include <algorithm>
#include <iostream>
#include <map>
#include <tuple>

namespace lodestone {
namespace {

// A LOD of fewer triangles lacks ears and toes at rest already; a vertex that flies off would still
// put its box off by more than the second number.
constexpr std::uint64_t kFewestForExtremities = 200;
constexpr double kMostOfFew = 0.2;

// The largest way by which a face of one box lies off the other's, in units of the diagonal.
double boxOff(const Bounds& box, const Bounds& original) {
    const glm::dvec3 lower = glm::abs(box.min - original.min);
    const glm::dvec3 upper = glm::abs(box.max - original.max);
    const glm::dvec3 worst = glm::max(lower, upper);
    return std::max(worst.x, std::max(worst.y, worst.z)) / original.diagonal();
}

bool deforms(const Scene& scene, const Rig& rig) {
    if (!rig.skins.empty())
        return true;
    for (const Submesh& submesh : scene.submeshes)
        for (const Primitive& primitive : submesh.primitives)
            if (!primitive.geometry->morph_targets.empty())
                return true;
    return false;
}

// How far a box reaches out of the other, in units of that one's diagonal.
double boxOutside(const Bounds& box, const Bounds& original) {
    const glm::dvec3 worst = glm::max(original.min - box.min, box.max - original.max);
    return std::max(worst.x, std::max(worst.y, worst.z)) / original.diagonal();
}

// At rest, at moments all over every animation, and with each morph target all the way.
struct Posture {
    std::string name;
    Rig rig;
    Moment moment;
};

std::vector<Posture> posturesOf(const Rig& rig) {
    constexpr int kMoments = 24;
    std::vector<Posture> postures{{"at rest", rig, {}}};
    for (std::uint32_t a = 0; a < rig.animations.size(); ++a)
        for (int k = 0; k <= kMoments; ++k) {
            const double time = rig.animations[a].duration_s * k / kMoments;
            postures.push_back(
                {"animation " + std::to_string(a) + " at " + std::to_string(time), rig, {a, time}});
        }
    for (std::size_t n = 0; n < rig.nodes.size(); ++n)
        for (std::size_t t = 0; t < rig.nodes[n].weights.size(); ++t) {
            postures.push_back({"target " + std::to_string(t), rig, {}});
            std::ranges::fill(postures.back().rig.nodes[n].weights, 0.0f);
            postures.back().rig.nodes[n].weights[t] = 1.0f;
        }
    return postures;
}

// How far vertices that lie at one place at rest come apart, over all postures.
double widestGap(const Scene& scene, const Lod& lod, const std::vector<Posture>& postures) {
    const auto less = [](const glm::vec3& a, const glm::vec3& b) {
        return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
    };
    double widest = 0.0;
    for (const Posture& posture : postures) {
        const Pose rest = poseAt(posture.rig, {});
        const Pose pose = poseAt(posture.rig, posture.moment);
        for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
            const InstancePose instance = instancePose(scene, posture.rig, rest, pose, i);
            std::vector<glm::dmat4> joints;
            if (instance.skin != kNone)
                joints = jointMatrices(posture.rig, pose, instance.skin);
            std::map<glm::vec3, glm::dvec3, decltype(less)> first(less);
            for (const GeometryPtr& geometry : lod.submeshes[scene.instances[i].submesh].primitives)
                for (std::size_t v = 0;
                     const glm::dvec3& at : posedPositions(*geometry, instance, joints)) {
                    const auto known = first.emplace(geometry->positions[v++], at).first;
                    widest = std::max(widest, glm::length(at - known->second));
                }
        }
    }
    return widest;
}

class ModelsPose : public tests::ModelsTest {};

TEST_F(ModelsPose, NoVertexExplodesWhileASimplifiedModelMoves) {
    int compared = 0;
    for (const std::filesystem::path& file : tests::modelFiles()) {
        const Result<ScenePtr> scene = importScene(file, {});
        if (!scene || !deforms(**scene, *readRig(**scene)))
            continue;
        const std::vector<Posture> postures = posturesOf(*readRig(**scene));
        for (const char* id : {"quadric", "ias"}) {
            const Result<LodSourcePtr> source = findAlgorithm(id)->prepare(*scene, {}, {}, {});
            ASSERT_TRUE(source) << source.error().message;
            const ScenePtr shown = (*source)->scene();
            const ByteModel bytes(shown, {});
            const Resolved at = (*source)->resolve({Target::Kind::Ratio, 0.2}, bytes);
            const Lod lod = (*source)->readOut(at.position, nullptr);
            const std::vector<Posture> shown_postures = posturesOf(*readRig(*shown));
            ASSERT_EQ(shown_postures.size(), postures.size()) << file;
            const double most = lod.triangles >= kFewestForExtremities ? 0.01 : kMostOfFew;
            double worst = 0.0;
            double outside = 0.0;
            for (std::size_t p = 0; p < postures.size(); ++p) {
                const Bounds was =
                    posedBounds(**scene, fullLod(**scene), postures[p].rig, postures[p].moment);
                const Bounds is =
                    posedBounds(*shown, lod, shown_postures[p].rig, shown_postures[p].moment);
                worst = std::max(worst, boxOff(is, was));
                outside = std::max(outside, boxOutside(is, was));
                EXPECT_LE(boxOff(is, was), most) << file << ' ' << id << ' ' << postures[p].name;
            }
            std::cout << file.filename().string() << ' ' << id << ' ' << lod.triangles
                      << " triangles, box off by at most " << 100.0 * worst << " %, outside by "
                      << 100.0 * outside << " %\n";
            ++compared;
        }
    }
    EXPECT_GE(compared, 16);
}

TEST_F(ModelsPose, SeamsStayClosedWhileASimplifiedModelMoves) {
    int compared = 0;
    for (const std::filesystem::path& file : tests::modelFiles()) {
        const Result<ScenePtr> scene = importScene(file, {});
        if (!scene || !deforms(**scene, *readRig(**scene)))
            continue;
        const std::vector<Posture> postures = posturesOf(*readRig(**scene));
        const double slack = 1e-5 * worldBounds(**scene).diagonal();
        const double original = widestGap(**scene, fullLod(**scene), postures);
        const Result<LodSourcePtr> source = findAlgorithm("ias")->prepare(*scene, {}, {}, {});
        ASSERT_TRUE(source) << source.error().message;
        const ByteModel bytes((*source)->scene(), {});
        for (const double ratio : {0.5, 0.2}) {
            const Resolved at = (*source)->resolve({Target::Kind::Ratio, ratio}, bytes);
            const Lod lod = (*source)->readOut(at.position, nullptr);
            EXPECT_LE(widestGap(**scene, lod, postures), original + slack) << file << ' ' << ratio;
        }
        ++compared;
    }
    EXPECT_GE(compared, 8);
}

} // namespace
} // namespace lodestone
