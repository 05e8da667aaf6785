#include "scene/pose.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lodestone {

namespace {

// Between two keys, as glTF 2.0, appendix C, has it.
struct Between {
    std::size_t before = 0; // key
    std::size_t after = 0;
    double share = 0.0;  // 0..1 of the way
    double span_s = 0.0; // between the keys
};

Between keysAround(const std::vector<float>& times_s, double time_s) {
    const auto after = std::ranges::upper_bound(
        times_s, time_s, {}, [](float time) { return static_cast<double>(time); });
    if (after == times_s.begin())
        return {};
    const auto key = static_cast<std::size_t>(after - times_s.begin());
    if (after == times_s.end())
        return {key - 1, key - 1, 0.0, 0.0};
    const double begin = static_cast<double>(times_s[key - 1]);
    const double span = static_cast<double>(times_s[key]) - begin;
    return {key - 1, key, (time_s - begin) / span, span};
}

class ChannelSampler {
public:
    ChannelSampler(const AnimationChannel& channel, double time_s)
        : channel_(channel), at_(keysAround(channel.times_s, time_s)) {}

    double component(std::size_t c) const {
        switch (channel_.interpolation) {
        case Interpolation::Step:
            return value(at_.before, c);
        case Interpolation::CubicSpline:
            return spline(c);
        case Interpolation::Linear:
            break;
        }
        return glm::mix(value(at_.before, c), value(at_.after, c), at_.share);
    }

    glm::dvec3 vector() const { return {component(0), component(1), component(2)}; }

    glm::dquat rotation() const {
        glm::dquat turned =
            channel_.interpolation == Interpolation::Linear
                ? glm::slerp(unit(key(at_.before)), unit(key(at_.after)), at_.share)
                : glm::dquat(component(3), component(0), component(1), component(2));
        return unit(turned);
    }

private:
    static glm::dquat unit(const glm::dquat& q) {
        const double length = glm::length(q);
        return length > 0.0 && std::isfinite(length) ? q / length : glm::dquat(1.0, 0.0, 0.0, 0.0);
    }

    glm::dquat key(std::size_t k) const {
        return {value(k, 3), value(k, 0), value(k, 1), value(k, 2)};
    }

    // part: 0 tangent in, 1 value, 2 tangent out.
    double splinePart(std::size_t k, std::size_t part, std::size_t c) const {
        return static_cast<double>(channel_.values[(3 * k + part) * channel_.components + c]);
    }

    double value(std::size_t k, std::size_t c) const {
        return channel_.interpolation == Interpolation::CubicSpline
                   ? splinePart(k, 1, c)
                   : static_cast<double>(channel_.values[k * channel_.components + c]);
    }

    double spline(std::size_t c) const {
        const double t = at_.share;
        const double t2 = t * t;
        const double t3 = t2 * t;
        return (2.0 * t3 - 3.0 * t2 + 1.0) * value(at_.before, c) +
               at_.span_s * (t3 - 2.0 * t2 + t) * splinePart(at_.before, 2, c) +
               (3.0 * t2 - 2.0 * t3) * value(at_.after, c) +
               at_.span_s * (t3 - t2) * splinePart(at_.after, 0, c);
    }

    const AnimationChannel& channel_;
    Between at_;
};

void apply(const AnimationChannel& channel,
           double time_s,
           std::vector<RigNode>& nodes,
           std::vector<std::vector<float>>& weights) {
    const ChannelSampler sampler(channel, time_s);
    RigNode& node = nodes[channel.node];
    switch (channel.path) {
    case AnimatedPath::Translation:
        node.trs.translation = sampler.vector();
        break;
    case AnimatedPath::Rotation:
        node.trs.rotation = sampler.rotation();
        break;
    case AnimatedPath::Scale:
        node.trs.scale = sampler.vector();
        break;
    case AnimatedPath::Weights:
        for (std::size_t c = 0; c < channel.components; ++c)
            weights[channel.node][c] = static_cast<float>(sampler.component(c));
        return;
    }
    node.matrix.reset(); // glTF: what is animated is a TRS
}

// Sums of weighted joints, one matrix a vertex.
class Skinning {
public:
    Skinning(const Geometry& geometry, std::span<const glm::dmat4> matrices) : matrices_(matrices) {
        for (std::size_t set = 0; set < sets_.size(); ++set) {
            const std::string number = std::to_string(set);
            sets_[set] = {findAttribute(geometry.attributes, "JOINTS_" + number),
                          findAttribute(geometry.attributes, "WEIGHTS_" + number)};
        }
    }

    // Nothing: no joint holds the vertex.
    std::optional<glm::dmat4> matrixOf(std::size_t vertex) const {
        glm::dmat4 sum(0.0);
        double total = 0.0;
        for (const auto& [joints, weights] : sets_) {
            if (joints == nullptr || weights == nullptr)
                continue;
            for (std::size_t c = 0; c < std::min(joints->components, weights->components); ++c) {
                const auto weight = static_cast<double>(attributeValue(*weights, vertex, c));
                const auto joint =
                    static_cast<std::size_t>(std::max(attributeValue(*joints, vertex, c), 0.0f));
                if (!(weight > 0.0) || matrices_.empty())
                    continue;
                sum += weight * matrices_[std::min(joint, matrices_.size() - 1)];
                total += weight;
            }
        }
        if (!(total > 0.0))
            return std::nullopt;
        return sum / total;
    }

private:
    std::span<const glm::dmat4> matrices_;
    std::array<std::pair<const Attribute*, const Attribute*>, 2> sets_{};
};

std::vector<bool> usedVertices(const Geometry& geometry) {
    std::vector<bool> used(geometry.positions.size(), geometry.indices.empty());
    for (const std::uint32_t index : geometry.indices)
        used[index] = true;
    return used;
}

} // namespace

Pose poseAt(const Rig& rig, const Moment& moment) {
    Pose pose;
    pose.worlds.assign(rig.nodes.size(), glm::dmat4(1.0));
    for (const RigNode& node : rig.nodes)
        pose.weights.push_back(node.weights);
    std::vector<RigNode> moved;
    if (moment.animation < rig.animations.size()) {
        moved = rig.nodes;
        for (const AnimationChannel& channel : rig.animations[moment.animation].channels)
            apply(channel, moment.time_s, moved, pose.weights);
    }
    const std::vector<RigNode>& nodes = moved.empty() ? rig.nodes : moved;
    for (const std::uint32_t n : rig.order) {
        const glm::dmat4 local = nodes[n].matrix ? *nodes[n].matrix : toMatrix(nodes[n].trs);
        pose.worlds[n] = nodes[n].parent == kNone ? local : pose.worlds[nodes[n].parent] * local;
    }
    return pose;
}

std::vector<glm::dmat4> jointMatrices(const Rig& rig, const Pose& pose, std::uint32_t skin) {
    const Skin& source = rig.skins[skin];
    std::vector<glm::dmat4> matrices(source.joints.size());
    for (std::size_t j = 0; j < matrices.size(); ++j)
        matrices[j] = pose.worlds[source.joints[j]] * source.inverse_binds[j];
    return matrices;
}

InstancePose instancePose(const Scene& scene,
                          const Rig& rig,
                          const Pose& rest,
                          const Pose& pose,
                          std::uint32_t instance) {
    const Instance& placed = scene.instances[instance];
    InstancePose result;
    result.transform = placed.transform;
    if (placed.node >= rig.node_of_scene_node.size())
        return result;
    const std::uint32_t node = rig.node_of_scene_node[placed.node];
    result.weights = pose.weights[node];
    if (rig.nodes[node].draws_in_skin && !rig.skins[rig.nodes[node].skin].joints.empty())
        result.skin = rig.nodes[node].skin;
    if (rest.worlds[node] == pose.worlds[node])
        return result;
    const glm::dmat4 row = placed.gpu_index == kNone
                               ? glm::dmat4(1.0)
                               : glm::inverse(scene.nodes[placed.node].world) * placed.transform;
    const glm::dmat4 transform = pose.worlds[node] * row;
    if (!std::isfinite(
            glm::dot(transform[0] + transform[1] + transform[2] + transform[3], glm::dvec4(1.0))))
        return result;
    result.transform = transform;
    result.moved = true;
    return result;
}

std::vector<glm::dvec3> posedPositions(const Geometry& geometry,
                                       const InstancePose& instance,
                                       std::span<const glm::dmat4> joints) {
    std::vector<glm::dvec3> positions(geometry.positions.begin(), geometry.positions.end());
    const std::size_t targets = std::min(geometry.morph_targets.size(), instance.weights.size());
    for (std::size_t t = 0; t < targets; ++t) {
        const Attribute* deltas = findAttribute(geometry.morph_targets[t].attributes, "POSITION");
        const auto weight = static_cast<double>(instance.weights[t]);
        if (deltas == nullptr || weight == 0.0)
            continue;
        for (std::size_t v = 0; v < positions.size(); ++v)
            for (std::size_t c = 0; c < 3; ++c)
                positions[v][static_cast<int>(c)] +=
                    weight * static_cast<double>(attributeValue(*deltas, v, c));
    }
    const Skinning skinning(geometry, joints);
    for (std::size_t v = 0; v < positions.size(); ++v) {
        const std::optional<glm::dmat4> skinned = skinning.matrixOf(v);
        positions[v] =
            glm::dvec3((skinned ? *skinned : instance.transform) * glm::dvec4(positions[v], 1.0));
    }
    return positions;
}

Bounds posedBounds(const Scene& scene, const Lod& lod, const Rig& rig, const Moment& moment) {
    const Pose rest = poseAt(rig, {});
    const Pose pose = poseAt(rig, moment);
    const std::vector<InstanceRange> ranges = instanceRanges(scene);
    Bounds bounds;
    for (std::size_t s = 0; s < lod.submeshes.size(); ++s) {
        const LodSubmesh& submesh = lod.submeshes[s];
        for (std::uint32_t place = 0; place < submesh.kept_instances; ++place) {
            const std::uint32_t id =
                submesh.instance_order ? (*submesh.instance_order)[place] : ranges[s].begin + place;
            const InstancePose instance = instancePose(scene, rig, rest, pose, id);
            std::vector<glm::dmat4> joints;
            if (instance.skin != kNone)
                joints = jointMatrices(rig, pose, instance.skin);
            for (const GeometryPtr& geometry : submesh.primitives) {
                const std::vector<bool> used = usedVertices(*geometry);
                const std::vector<glm::dvec3> positions =
                    posedPositions(*geometry, instance, joints);
                for (std::size_t v = 0; v < positions.size(); ++v)
                    if (used[v])
                        bounds.add(positions[v]);
            }
        }
    }
    return bounds;
}

} // namespace lodestone
