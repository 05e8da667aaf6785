#include "scene/gltf/accessor_reader.h"
#include "scene/rig.h"

#include <algorithm>
#include <cmath>

namespace lodestone {

using nlohmann::json;

namespace {

std::vector<float> numbersOf(const json& list) {
    std::vector<float> numbers;
    for (const json& number : list)
        numbers.push_back(number.get<float>());
    return numbers;
}

Trs trsOf(const json& node) {
    Trs trs;
    const auto vector = [&](const char* key, const glm::dvec3& otherwise) {
        const json* value = member(node, key);
        return value == nullptr ? otherwise
                                : glm::dvec3((*value)[0].get<double>(),
                                             (*value)[1].get<double>(),
                                             (*value)[2].get<double>());
    };
    trs.translation = vector("translation", glm::dvec3(0.0));
    trs.scale = vector("scale", glm::dvec3(1.0));
    if (const json* r = member(node, "rotation")) {
        const glm::dquat rotation((*r)[3].get<double>(),
                                  (*r)[0].get<double>(),
                                  (*r)[1].get<double>(),
                                  (*r)[2].get<double>());
        if (const double length = glm::length(rotation); length > 0.0)
            trs.rotation = rotation / length;
    }
    return trs;
}

std::size_t morphTargets(const Submesh& submesh) {
    std::size_t count = 0;
    for (const Primitive& primitive : submesh.primitives)
        count = std::max(count, primitive.geometry->morph_targets.size());
    return count;
}

class RigReader {
public:
    explicit RigReader(const Scene& scene)
        : scene_(scene), document_(scene.source->json), accessors_(*scene.source) {}

    Rig read() {
        readNodes();
        readSkins();
        const json& animations = listOf(document_, "animations");
        for (std::size_t a = 0; a < animations.size(); ++a)
            readAnimation(animations[a], a);
        return std::move(rig_);
    }

private:
    void readNodes() {
        const json& nodes = listOf(document_, "nodes");
        rig_.nodes.resize(nodes.size());
        rig_.node_of_scene_node = scene_.source->node_of_node;
        for (std::size_t n = 0; n < nodes.size(); ++n) {
            for (const json& child : listOf(nodes[n], "children"))
                rig_.nodes[*asUnsigned(child)].parent = static_cast<std::uint32_t>(n);
            if (const json* values = member(nodes[n], "matrix")) {
                glm::dmat4 matrix;
                for (int i = 0; i < 16; ++i)
                    matrix[i / 4][i % 4] = (*values)[static_cast<std::size_t>(i)].get<double>();
                rig_.nodes[n].matrix = matrix;
            }
            rig_.nodes[n].trs = trsOf(nodes[n]);
            rig_.nodes[n].skin =
                static_cast<std::uint32_t>(unsignedMember(nodes[n], "skin").value_or(kNone));
        }
        orderNodes();
        for (std::size_t n = 0; n < scene_.nodes.size(); ++n)
            readMeshState(scene_.nodes[n], rig_.node_of_scene_node[n]);
    }

    void orderNodes() {
        std::vector<std::vector<std::uint32_t>> children(rig_.nodes.size());
        for (std::uint32_t n = 0; n < rig_.nodes.size(); ++n) {
            const std::uint32_t parent = rig_.nodes[n].parent;
            (parent == kNone ? rig_.order : children[parent]).push_back(n);
        }
        for (std::size_t at = 0; at < rig_.order.size(); ++at) {
            const std::vector<std::uint32_t>& below = children[rig_.order[at]];
            rig_.order.insert(rig_.order.end(), below.begin(), below.end());
        }
    }

    // The node's own weights before its mesh's.
    void readMeshState(const Node& node, std::uint32_t n) {
        if (node.submesh == kNone)
            return;
        RigNode& rigged = rig_.nodes[n];
        rigged.draws_in_skin = rigged.skin != kNone;
        const json& mesh =
            listOf(document_, "meshes")[scene_.source->mesh_of_submesh[node.submesh]];
        for (const json* owner : {&mesh, &listOf(document_, "nodes")[n]})
            if (const json* weights = member(*owner, "weights"); weights && !weights->empty())
                rigged.weights = numbersOf(*weights);
        rigged.weights.resize(morphTargets(scene_.submeshes[node.submesh]), 0.0f);
        for (float& weight : rigged.weights)
            weight = std::isfinite(weight) ? weight : 0.0f;
    }

    void readSkins() {
        const json& skins = listOf(document_, "skins");
        for (std::size_t s = 0; s < skins.size(); ++s) {
            Skin skin;
            for (const json& joint : skins[s]["joints"])
                skin.joints.push_back(static_cast<std::uint32_t>(*asUnsigned(joint)));
            skin.inverse_binds.assign(skin.joints.size(), glm::dmat4(1.0));
            if (const auto index = unsignedMember(skins[s], "inverseBindMatrices"))
                readInverseBinds(*index, s, skin);
            rig_.skins.push_back(std::move(skin));
        }
    }

    void readInverseBinds(std::uint64_t index, std::size_t s, Skin& skin) {
        const std::optional<Values> values = readValues(index);
        if (!values || values->components != 16 ||
            values->numbers.size() < 16 * skin.joints.size()) {
            rig_.notes.push_back(label("skin", s, "") +
                                 ": its inverse bind matrices cannot be read: it is drawn as if "
                                 "they were identities");
            return;
        }
        for (std::size_t j = 0; j < skin.joints.size(); ++j)
            for (int i = 0; i < 16; ++i)
                skin.inverse_binds[j][i / 4][i % 4] =
                    static_cast<double>(values->numbers[16 * j + static_cast<std::size_t>(i)]);
    }

    struct Values {
        std::vector<float> numbers; // finite
        std::size_t components = 1;
    };

    // Nothing: unreadable or not finite.
    std::optional<Values> readValues(std::uint64_t index) {
        const Result<AccessorPtr> data = accessors_.read(index);
        if (!data)
            return std::nullopt;
        Attribute decoder;
        decoder.type = (*data)->type;
        decoder.components = (*data)->components;
        decoder.normalized = (*data)->normalized;
        decoder.bytes = (*data)->bytes;
        Values values;
        values.components = decoder.components;
        values.numbers.resize((*data)->count * values.components);
        for (std::size_t i = 0; i < values.numbers.size(); ++i) {
            values.numbers[i] =
                attributeValue(decoder, i / values.components, i % values.components);
            if (!std::isfinite(values.numbers[i]))
                return std::nullopt;
        }
        return values;
    }

    void readAnimation(const json& source, std::size_t a) {
        SceneAnimation animation;
        animation.name = stringMember(source, "name");
        std::size_t unread = 0;
        for (const json& channel : source["channels"]) {
            const json& target = channel["target"];
            const auto node = unsignedMember(target, "node");
            if (!node)
                continue; // nothing to move, or something else than a node (an extension's)
            const auto sampler = unsignedMember(channel, "sampler");
            std::optional<AnimationChannel> read;
            if (sampler && *sampler < source["samplers"].size())
                read = readChannel(source["samplers"][*sampler],
                                   static_cast<std::uint32_t>(*node),
                                   stringMember(target, "path"));
            if (!read) {
                ++unread;
                continue;
            }
            animation.duration_s =
                std::max(animation.duration_s, static_cast<double>(read->times_s.back()));
            animation.channels.push_back(std::move(*read));
        }
        if (unread > 0)
            rig_.notes.push_back(label("animation", a, animation.name) + ": " +
                                 std::to_string(unread) + " of " +
                                 std::to_string(source["channels"].size()) +
                                 " channels cannot be played and stay at rest");
        rig_.animations.push_back(std::move(animation));
    }

    std::optional<AnimationChannel>
    readChannel(const json& sampler, std::uint32_t node, const std::string& path) {
        AnimationChannel channel;
        channel.node = node;
        const bool is_weights = path == "weights";
        if (path == "rotation")
            channel.path = AnimatedPath::Rotation;
        else if (path == "scale")
            channel.path = AnimatedPath::Scale;
        else if (is_weights)
            channel.path = AnimatedPath::Weights;
        else if (path != "translation")
            return std::nullopt;
        const std::string interpolation = stringMember(sampler, "interpolation");
        if (interpolation == "STEP")
            channel.interpolation = Interpolation::Step;
        else if (interpolation == "CUBICSPLINE")
            channel.interpolation = Interpolation::CubicSpline;
        const auto input = unsignedMember(sampler, "input");
        const auto output = unsignedMember(sampler, "output");
        std::optional<Values> times = input ? readValues(*input) : std::nullopt;
        std::optional<Values> values = output ? readValues(*output) : std::nullopt;
        if (!times || !values || times->components != 1 || times->numbers.empty() ||
            !std::ranges::is_sorted(times->numbers))
            return std::nullopt;
        const std::size_t per_key =
            channel.interpolation == Interpolation::CubicSpline ? std::size_t{3} : std::size_t{1};
        const std::size_t keys = times->numbers.size() * per_key;
        const std::size_t components =
            is_weights ? rig_.nodes[node].weights.size()
                       : (channel.path == AnimatedPath::Rotation ? std::size_t{4} : std::size_t{3});
        const std::size_t stored = is_weights ? std::size_t{1} : components;
        if (components == 0 || values->components != stored ||
            values->numbers.size() != keys * components)
            return std::nullopt;
        channel.components = static_cast<std::uint32_t>(components);
        channel.times_s = std::move(times->numbers);
        channel.values = std::move(values->numbers);
        return channel;
    }

    const Scene& scene_;
    const json& document_;
    AccessorReader accessors_;
    Rig rig_;
};

} // namespace

RigPtr readRig(const Scene& scene) {
    if (!scene.source)
        return std::make_shared<const Rig>();
    try {
        return std::make_shared<const Rig>(RigReader(scene).read());
    } catch (const json::exception& e) {
        Rig rig;
        rig.notes.push_back("the animations cannot be read (" +
                            std::string(e.what()).substr(0, 120) + "): nothing moves");
        return std::make_shared<const Rig>(std::move(rig));
    }
}

} // namespace lodestone
