#include "render/gpu_pose.h"

#include <algorithm>
#include <map>

namespace lodestone {

namespace {

// Texels are found by floats, which count so far without a gap.
constexpr std::size_t kMostTexels = std::size_t{1} << 24u;

class PosePacker {
public:
    PosePacker(const PoseSource& source, const Moment& moment)
        : source_(source), pose_(poseAt(source.rig, moment)) {
        packed_.submeshes.resize(source.submeshes.size());
    }

    PackedPose pack() {
        for (std::uint32_t s = 0; s < source_.submeshes.size(); ++s)
            if (moves(s))
                packSubmesh(s);
        if (packed_.texels.size() > kMostTexels)
            return stillPose();
        return std::move(packed_);
    }

private:
    PackedPose stillPose() const {
        PackedPose still;
        still.submeshes.resize(source_.submeshes.size());
        return still;
    }

    InstancePose instance(std::uint32_t id) const {
        return instancePose(source_.scene, source_.rig, source_.rest, pose_, id);
    }

    // Nodes neither animated nor skinned nor morphed are skipped early.
    bool mayMove(std::uint32_t id) const {
        const std::uint32_t node = source_.scene.instances[id].node;
        if (node >= source_.rig.node_of_scene_node.size())
            return false;
        const RigNode& rigged = source_.rig.nodes[source_.rig.node_of_scene_node[node]];
        return source_.scene.nodes[node].animated || rigged.draws_in_skin ||
               !rigged.weights.empty();
    }

    bool moves(std::uint32_t s) {
        const InstanceRange range = source_.submeshes[s].range;
        SubmeshPose& pose = packed_.submeshes[s];
        for (std::uint32_t id = range.begin; id < range.end; ++id) {
            if (!mayMove(id))
                continue;
            const InstancePose posed = instance(id);
            pose.posed = pose.posed || posed.moved || posed.skin != kNone;
            pose.morphed = pose.morphed || std::ranges::any_of(posed.weights, [](float weight) {
                               return weight != 0.0f;
                           });
        }
        return pose.posed || pose.morphed;
    }

    void packSubmesh(std::uint32_t s) {
        const InstanceRange range = source_.submeshes[s].range;
        SubmeshPose& pose = packed_.submeshes[s];
        const std::size_t table = packed_.texels.size();
        pose.first_row = static_cast<std::int32_t>(table) - static_cast<std::int32_t>(range.begin);
        packed_.texels.resize(table + range.size());
        std::map<std::uint32_t, glm::vec2> skins; // first texel, last joint
        std::uint32_t mirrored = 0;
        for (std::uint32_t id = range.begin; id < range.end; ++id) {
            const InstancePose posed = instance(id);
            glm::vec2 place(0.0f);
            if (posed.skin == kNone) {
                if (posed.moved)
                    remember(id, posed.transform);
                place.x = static_cast<float>(packed_.texels.size());
                putMatrix(posed.transform, s);
            } else if (const auto known = skins.find(posed.skin); known != skins.end()) {
                place = known->second;
            } else {
                place = putSkin(posed.skin, s);
                skins.emplace(posed.skin, place);
            }
            mirrored += isMirrored(place.x) ? 1 : 0;
            const auto weights = static_cast<float>(packed_.texels.size());
            putWeights(posed.weights);
            packed_.texels[table + id - range.begin] = {place.x, place.y, weights, 0.0f};
        }
        if (mirrored > 0)
            pose.mirroring = mirrored == range.size() ? Mirroring::All : Mirroring::Mixed;
    }

    void remember(std::uint32_t id, const glm::dmat4& transform) {
        if (packed_.transforms.empty())
            for (const Instance& placed : source_.scene.instances)
                packed_.transforms.push_back(placed.transform);
        packed_.transforms[id] = transform;
    }

    glm::vec2 putSkin(std::uint32_t skin, std::uint32_t s) {
        const auto first = static_cast<float>(packed_.texels.size());
        const std::vector<glm::dmat4> joints = jointMatrices(source_.rig, pose_, skin);
        for (const glm::dmat4& joint : joints)
            putMatrix(joint, s);
        return {first, static_cast<float>(joints.size() - 1)};
    }

    void putMatrix(const glm::dmat4& world, std::uint32_t s) {
        const GpuSubmesh& submesh = source_.submeshes[s];
        for (const glm::vec4& row : sceneRows(world, source_.frame, submesh.frame))
            packed_.texels.push_back(row);
        double stretch = 0.0; // Frobenius: never less than the largest
        for (int c = 0; c < 3; ++c)
            stretch += glm::dot(glm::dvec3(world[c]), glm::dvec3(world[c]));
        const glm::dvec3 center(world * glm::dvec4(submesh.box.center(), 1.0));
        const double radius = submesh.box.diagonal() * 0.5 * std::sqrt(stretch);
        if (!submesh.box.empty && std::isfinite(glm::dot(center, glm::dvec3(1.0)) + radius)) {
            packed_.reach.add(center - radius);
            packed_.reach.add(center + radius);
        }
    }

    bool isMirrored(float first_texel) const {
        const auto at = static_cast<std::size_t>(first_texel);
        const glm::vec3 x(packed_.texels[at]);
        const glm::vec3 y(packed_.texels[at + 1]);
        const glm::vec3 z(packed_.texels[at + 2]);
        return glm::dot(glm::cross(y, z), x) < 0.0f;
    }

    void putWeights(std::span<const float> weights) {
        for (std::size_t w = 0; w < weights.size(); w += 4) {
            glm::vec4 texel(0.0f);
            for (std::size_t c = 0; c < 4 && w + c < weights.size(); ++c)
                texel[static_cast<int>(c)] = weights[w + c];
            packed_.texels.push_back(texel);
        }
    }

    const PoseSource& source_;
    Pose pose_;
    PackedPose packed_;
};

} // namespace

PackedPose packPose(const PoseSource& source, const Moment& moment) {
    return PosePacker(source, moment).pack();
}

} // namespace lodestone
