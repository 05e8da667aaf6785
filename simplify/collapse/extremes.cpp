#include "simplify/collapse/extremes.h"

#include "scene/pose.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>
#include <tbb/parallel_for.h>

namespace lodestone {

// --- postures

namespace {

constexpr std::size_t kMostMoments = 64;
constexpr std::size_t kMostTargets = 64;

bool deforms(const Submesh& submesh) {
    return std::ranges::any_of(submesh.primitives, [](const Primitive& primitive) {
        return !primitive.geometry->morph_targets.empty() ||
               findAttribute(primitive.geometry->attributes, "JOINTS_0") != nullptr;
    });
}

std::vector<Moment> spreadMoments(const Rig& rig) {
    constexpr std::size_t kEach = 16; // of one animation at most
    std::vector<Moment> moments{{}};
    const std::size_t animations = std::min(rig.animations.size(), kMostMoments);
    for (std::uint32_t a = 0; a < animations; ++a) {
        const std::size_t count = std::min(kEach, kMostMoments / animations);
        for (std::size_t k = 0; k < count; ++k)
            moments.push_back({a,
                               rig.animations[a].duration_s * (static_cast<double>(k) + 0.5) /
                                   static_cast<double>(count)});
    }
    return moments;
}

// The joints of a rig's skins at one moment, each made once.
class PosedSkins {
public:
    PosedSkins(const Rig& rig, const Pose& pose)
        : rig_(rig), pose_(pose), made_(rig.skins.size()) {}

    std::shared_ptr<const std::vector<glm::mat4>> at(std::uint32_t skin) {
        if (!made_[skin]) {
            const std::vector<glm::dmat4> exact = jointMatrices(rig_, pose_, skin);
            made_[skin] =
                std::make_shared<const std::vector<glm::mat4>>(exact.begin(), exact.end());
        }
        return made_[skin];
    }

private:
    const Rig& rig_;
    const Pose& pose_;
    std::vector<std::shared_ptr<const std::vector<glm::mat4>>> made_; // [skins]
};

} // namespace

std::vector<std::vector<Posture>> deformingPostures(const Scene& scene) {
    std::vector<std::vector<Posture>> postures(scene.submeshes.size());
    if (std::ranges::none_of(scene.submeshes, deforms))
        return postures;
    const RigPtr rig = readRig(scene);
    const std::vector<InstanceRange> ranges = instanceRanges(scene);
    const Pose rest = poseAt(*rig, {});
    for (const Moment& moment : spreadMoments(*rig)) {
        const Pose pose = poseAt(*rig, moment);
        PosedSkins skins(*rig, pose);
        for (std::size_t s = 0; s < postures.size(); ++s) {
            if (ranges[s].size() == 0 || !deforms(scene.submeshes[s]))
                continue;
            const InstancePose instance = instancePose(scene, *rig, rest, pose, ranges[s].begin);
            postures[s].push_back({instance.transform,
                                   instance.skin == kNone ? nullptr : skins.at(instance.skin),
                                   {instance.weights.begin(), instance.weights.end()}});
        }
    }
    for (std::vector<Posture>& all : postures)
        for (std::size_t t = 0;
             !all.empty() && t < std::min(all.front().weights.size(), kMostTargets);
             ++t) {
            Posture one = all.front(); // at rest
            std::ranges::fill(one.weights, 0.0f);
            one.weights[t] = 1.0f;
            all.push_back(std::move(one));
        }
    return postures;
}

// --- vertices

namespace {

// Places welded vertices in postures. As posedPositions(), of the values already gathered.
class Placer {
public:
    Placer(const Complex& complex, const WedgeAttributes& attributes)
        : complex_(complex), attributes_(attributes), wedge_(complex.positions.size(), kNone) {
        for (const WedgeAttributes::PrimitiveLayout& layout : attributes.primitives)
            targets_.push_back(targetOffsets(layout));
        for (const std::array<std::uint32_t, 3>& face : complex.faces)
            for (const std::uint32_t w : face)
                if (std::uint32_t& first = wedge_[complex.wedge_vertex[w]]; first == kNone)
                    first = w; // all that lie at one place move alike
        for (std::size_t p = 0; p + 1 < complex.wedge_begin.size(); ++p)
            primitive_.insert(primitive_.end(),
                              complex.wedge_begin[p + 1] - complex.wedge_begin[p],
                              static_cast<std::uint32_t>(p));
    }

    // Some face has it.
    bool has(std::uint32_t vertex) const { return wedge_[vertex] != kNone; }

    glm::vec3 at(std::uint32_t vertex, const Posture& posture) const {
        const std::uint32_t wedge = wedge_[vertex];
        const float* values = attributes_.values.data() + std::size_t{wedge} * attributes_.size;
        const std::vector<std::uint32_t>& targets = targets_[primitive_[wedge]];
        glm::vec4 place(complex_.positions[vertex], 1.0f);
        for (std::size_t t = 0; t < std::min(targets.size(), posture.weights.size()); ++t)
            for (int c = 0; c < 3 && posture.weights[t] != 0.0f && targets[t] != kNone; ++c)
                place[c] += posture.weights[t] * values[targets[t] + static_cast<std::uint32_t>(c)];
        const std::optional<glm::vec3> skinned =
            posture.joints && !posture.joints->empty()
                ? inSkin(attributes_.primitives[primitive_[wedge]], values, *posture.joints, place)
                : std::nullopt;
        return skinned ? *skinned : glm::vec3(posture.transform * place);
    }

private:
    // Nothing: no joint holds it.
    static std::optional<glm::vec3> inSkin(const WedgeAttributes::PrimitiveLayout& layout,
                                           const float* values,
                                           std::span<const glm::mat4> joints,
                                           const glm::vec4& place) {
        glm::vec3 sum(0.0f);
        float total = 0.0f;
        const auto last = static_cast<float>(joints.size() - 1);
        for (const WedgeAttributes::SkinSet& set : layout.skin)
            for (std::size_t i = 0; i < 4; ++i) {
                const float weight = values[set.weights + i];
                if (!(weight > 0.0f))
                    continue;
                const float joint = values[set.joints + i];
                const auto index =
                    static_cast<std::size_t>(joint > 0.0f ? std::min(joint, last) : 0.0f);
                sum += weight * glm::vec3(joints[index] * place);
                total += weight;
            }
        if (!(total > 0.0f))
            return std::nullopt;
        return sum / total;
    }

    // Where a morph target has its positions among a wedge's values; kNone: it has none.
    static std::vector<std::uint32_t>
    targetOffsets(const WedgeAttributes::PrimitiveLayout& layout) {
        std::vector<std::uint32_t> offsets;
        for (const std::vector<WedgeAttributes::Slot>& slots : layout.morph_slots) {
            const auto slot = std::ranges::find_if(slots, &WedgeAttributes::Slot::moves);
            const bool found = slot != slots.end() && slot->components == 3;
            offsets.push_back(found ? slot->offset : kNone);
        }
        return offsets;
    }

    const Complex& complex_;
    const WedgeAttributes& attributes_;
    std::vector<std::vector<std::uint32_t>> targets_; // [primitives][targets]
    std::vector<std::uint32_t> wedge_;                // [vertices] the first
    std::vector<std::uint32_t> primitive_;            // [wedges]
};

using Sides = std::array<std::vector<std::uint32_t>, 6>; // of a box: the vertices near each

Sides nearSides(const Placer& placer,
                std::span<const std::uint32_t> vertices,
                const Posture& posture) {
    constexpr float kNear = 0.0025f; // of the diagonal
    std::vector<glm::vec3> places(vertices.size());
    glm::vec3 low(std::numeric_limits<float>::max());
    glm::vec3 high(std::numeric_limits<float>::lowest());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        places[i] = placer.at(vertices[i], posture);
        low = glm::min(low, places[i]);
        high = glm::max(high, places[i]);
    }
    Sides sides;
    const float reach = kNear * glm::length(high - low);
    if (!std::isfinite(reach)) // nonsense of the file
        return sides;
    for (std::size_t i = 0; i < vertices.size(); ++i)
        for (int axis = 0; axis < 3; ++axis) {
            const auto side = 2 * static_cast<std::size_t>(axis);
            if (places[i][axis] <= low[axis] + reach)
                sides[side].push_back(vertices[i]);
            if (places[i][axis] >= high[axis] - reach)
                sides[side + 1].push_back(vertices[i]);
        }
    return sides;
}

// Greedily: the vertex that is near most sides not yet reached, the first of equals.
std::vector<std::uint32_t> coverSides(const std::vector<const std::vector<std::uint32_t>*>& sides,
                                      std::size_t vertex_count) {
    std::vector<std::vector<std::uint32_t>> of_vertex(vertex_count);
    for (std::uint32_t side = 0; side < sides.size(); ++side)
        for (const std::uint32_t vertex : *sides[side])
            of_vertex[vertex].push_back(side);
    std::vector<bool> reached(sides.size(), false);
    using Entry = std::pair<std::size_t, std::uint32_t>; // sides, vertex from the last
    std::priority_queue<Entry> queue;
    const auto last = static_cast<std::uint32_t>(vertex_count);
    for (std::uint32_t v = 0; v < last; ++v)
        if (!of_vertex[v].empty())
            queue.push({of_vertex[v].size(), last - v});
    std::vector<std::uint32_t> chosen;
    while (!queue.empty()) {
        const auto [count, place] = queue.top();
        queue.pop();
        const std::uint32_t vertex = last - place;
        const auto now = static_cast<std::size_t>(std::ranges::count_if(
            of_vertex[vertex], [&](std::uint32_t side) { return !reached[side]; }));
        if (now == 0)
            continue;
        if (now < count) {
            queue.push({now, place});
            continue;
        }
        chosen.push_back(vertex);
        for (const std::uint32_t side : of_vertex[vertex])
            reached[side] = true;
    }
    std::ranges::sort(chosen);
    return chosen;
}

} // namespace

std::vector<std::uint32_t> extremeVertices(const Complex& complex,
                                           const WedgeAttributes& attributes,
                                           std::span<const Posture> postures) {
    constexpr std::size_t kMostPlaces = 4'000'000;
    if (postures.empty())
        return {};
    const Placer placer(complex, attributes);
    std::vector<std::uint32_t> vertices;
    for (std::uint32_t v = 0; v < complex.positions.size(); ++v)
        if (placer.has(v) && complex.bulk.holds(glm::dvec3(complex.positions[v])))
            vertices.push_back(v);
    if (vertices.empty())
        return {};
    const std::size_t every = 1 + vertices.size() * postures.size() / kMostPlaces;
    std::vector<Sides> all((postures.size() + every - 1) / every);
    tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t i) {
        all[i] = nearSides(placer, vertices, postures[i * every]);
    });
    std::vector<const std::vector<std::uint32_t>*> sides;
    for (const Sides& one : all)
        for (const std::vector<std::uint32_t>& side : one)
            sides.push_back(&side);
    return coverSides(sides, complex.positions.size());
}

} // namespace lodestone
