#include "scene/pose.h"
#include "simplify/algorithm.h"
#include "tests/models_folder.h"
#include "tests/simplify/meshes.h"

#include <algorithm>
#include <iostream>
#include <map>

namespace lodestone {
namespace {

// A LOD of a handful of triangles, four of a cube's twelve, cannot fill the box; a vertex that
// flies off would still put it off by more than the second number.
constexpr std::uint64_t kFewestForExtremities = 30;
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
    double widest = 0.0;
    for (const Posture& posture : postures) {
        const Pose rest = poseAt(posture.rig, {});
        const Pose pose = poseAt(posture.rig, posture.moment);
        for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
            const InstancePose instance = instancePose(scene, posture.rig, rest, pose, i);
            std::vector<glm::dmat4> joints;
            if (instance.skin != kNone)
                joints = jointMatrices(posture.rig, pose, instance.skin);
            std::map<glm::vec3, glm::dvec3, meshes::LessByPlace> first;
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

// A model that moves, and all the ways it does.
struct Moving {
    std::filesystem::path file;
    ScenePtr scene;
    std::vector<Posture> postures;
};

std::vector<Moving> movingModels() {
    std::vector<Moving> models;
    for (const std::filesystem::path& file : tests::modelFiles()) {
        const Result<ScenePtr> scene = importScene(file, {});
        if (!scene)
            continue;
        const auto rig = readRig(**scene);
        if (deforms(**scene, *rig))
            models.push_back({file, *scene, posturesOf(*rig)});
    }
    return models;
}

LodSourcePtr preparedBy(const char* id, const ScenePtr& scene) {
    const Result<LodSourcePtr> source = findAlgorithm(id)->prepare(scene, {}, {}, {});
    EXPECT_TRUE(source) << source.error().message;
    return source ? *source : nullptr;
}

Lod lodAtRatio(const LodSource& source, double ratio) {
    const Resolved at = source.resolve({Target::Kind::Ratio, ratio}, ByteModel(source.scene(), {}));
    return source.readOut(at.position, nullptr);
}

// The worst over all postures, in units of the diagonal.
struct BoxError {
    double off = 0.0;
    double outside = 0.0;
};

BoxError worstBox(const Moving& model, const Scene& shown, const Lod& lod) {
    const std::vector<Posture> postures = posturesOf(*readRig(shown));
    EXPECT_EQ(postures.size(), model.postures.size()) << model.file;
    const Lod full = fullLod(*model.scene);
    BoxError worst;
    for (std::size_t p = 0; p < std::min(postures.size(), model.postures.size()); ++p) {
        const Posture& original = model.postures[p];
        const Bounds was = posedBounds(*model.scene, full, original.rig, original.moment);
        const Bounds is = posedBounds(shown, lod, postures[p].rig, postures[p].moment);
        worst.off = std::max(worst.off, boxOff(is, was));
        worst.outside = std::max(worst.outside, boxOutside(is, was));
    }
    return worst;
}

class ModelsPose : public tests::ModelsTest {};

TEST_F(ModelsPose, NoVertexExplodesWhileASimplifiedModelMoves) {
    const std::vector<Moving> models = movingModels();
    EXPECT_GE(models.size(), 8u);
    for (const Moving& model : models)
        for (const char* id : {"quadric", "ias"}) {
            const LodSourcePtr source = preparedBy(id, model.scene);
            ASSERT_TRUE(source);
            const Lod lod = lodAtRatio(*source, 0.2);
            const BoxError worst = worstBox(model, *source->scene(), lod);
            EXPECT_LE(worst.off, lod.triangles >= kFewestForExtremities ? 0.01 : kMostOfFew)
                << model.file << ' ' << id;
            std::cout << model.file.filename().string() << ' ' << id << ' ' << lod.triangles
                      << " triangles, box off by at most " << 100.0 * worst.off << " %, outside by "
                      << 100.0 * worst.outside << " %\n";
        }
}

TEST_F(ModelsPose, SeamsStayClosedWhileASimplifiedModelMoves) {
    const std::vector<Moving> models = movingModels();
    EXPECT_GE(models.size(), 8u);
    for (const Moving& model : models) {
        const Scene& scene = *model.scene;
        const double most =
            widestGap(scene, fullLod(scene), model.postures) + 1e-5 * worldBounds(scene).diagonal();
        const LodSourcePtr source = preparedBy("ias", model.scene);
        ASSERT_TRUE(source);
        for (const double ratio : {0.5, 0.2})
            EXPECT_LE(widestGap(scene, lodAtRatio(*source, ratio), model.postures), most)
                << model.file << ' ' << ratio;
    }
}

} // namespace
} // namespace lodestone
