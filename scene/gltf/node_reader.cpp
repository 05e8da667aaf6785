#include "scene/gltf/node_reader.h"

#include "scene/finite.h"
#include "scene/gltf/node_tree.h"
#include "scene/scene_builder.h"

#include <algorithm>
#include <cmath>

namespace lodestone {

using nlohmann::json;

namespace {

constexpr const char* kGpuInstancing = "EXT_mesh_gpu_instancing";

std::string nodeName(const ReadContext& context, std::uint32_t node) {
    return label("node", node, context.scene.nodes[node].name);
}

glm::dvec3 vectorMember(const json& node, std::string_view key, const glm::dvec3& otherwise) {
    const json* value = member(node, key);
    return value == nullptr ? otherwise
                            : glm::dvec3((*value)[0].get<double>(),
                                         (*value)[1].get<double>(),
                                         (*value)[2].get<double>());
}

glm::dquat unitOrIdentity(const glm::dquat& q) {
    const double length = glm::length(q);
    return length > 0.0 && std::isfinite(length) ? q / length : glm::dquat(1.0, 0.0, 0.0, 0.0);
}

// Nothing: the matrix is not affine.
std::optional<glm::dmat4> localTransform(const json& node) {
    if (const json* values = member(node, "matrix")) {
        glm::dmat4 matrix;
        for (int i = 0; i < 16; ++i)
            matrix[i / 4][i % 4] = (*values)[static_cast<std::size_t>(i)].get<double>();
        for (int column = 0; column < 4; ++column) {
            const double expected = column == 3 ? 1.0 : 0.0;
            if (!(std::abs(matrix[column][3] - expected) < 1e-6))
                return std::nullopt;
            matrix[column][3] = expected;
        }
        return matrix;
    }
    Trs trs;
    trs.translation = vectorMember(node, "translation", glm::dvec3(0.0));
    trs.scale = vectorMember(node, "scale", glm::dvec3(1.0));
    if (const json* r = member(node, "rotation"))
        trs.rotation = unitOrIdentity(glm::dquat((*r)[3].get<double>(),
                                                 (*r)[0].get<double>(),
                                                 (*r)[1].get<double>(),
                                                 (*r)[2].get<double>()));
    return toMatrix(trs);
}

// What animation channels move.
struct AnimationTargets {
    std::vector<bool> transform; // [nodes] the node and all below it
    std::vector<bool> weights;   // [nodes] the node alone
};

// Node of a KHR_animation_pointer path: "/nodes/12/translation".
std::optional<std::uint64_t> pointedNode(const json& target) {
    const json* pointer = extension(target, "KHR_animation_pointer");
    const std::string path = pointer == nullptr ? "" : stringMember(*pointer, "pointer");
    constexpr std::string_view kPrefix = "/nodes/";
    if (!path.starts_with(kPrefix))
        return std::nullopt;
    std::uint64_t node = 0;
    for (std::size_t i = kPrefix.size(); i < path.size() && path[i] != '/'; ++i) {
        if (path[i] < '0' || path[i] > '9' || node > 0xFFFFFFFFu)
            return std::nullopt;
        node = node * 10 + static_cast<std::uint64_t>(path[i] - '0');
    }
    return node;
}

AnimationTargets findAnimationTargets(const json& document) {
    const std::size_t node_count = listOf(document, "nodes").size();
    AnimationTargets targets{std::vector<bool>(node_count), std::vector<bool>(node_count)};
    for (const json& animation : listOf(document, "animations"))
        for (const json& channel : animation["channels"]) {
            const json& target = channel["target"];
            std::optional<std::uint64_t> node = unsignedMember(target, "node");
            if (!node)
                node = pointedNode(target);
            if (!node || *node >= node_count)
                continue;
            const bool is_weights = stringMember(target, "path") == "weights";
            (is_weights ? targets.weights : targets.transform)[*node] = true;
        }
    return targets;
}

Camera readCamera(const json& source, const glm::dmat4& world) {
    Camera camera;
    camera.name = stringMember(source, "name");
    camera.world = world;
    camera.perspective = stringMember(source, "type") != "orthographic";
    const json* lens = member(source, camera.perspective ? "perspective" : "orthographic");
    if (lens == nullptr)
        return camera;
    camera.yfov_rad = numberMember(*lens, "yfov", camera.yfov_rad);
    camera.znear = numberMember(*lens, "znear", camera.znear);
    camera.zfar = numberMember(*lens, "zfar", 0.0);
    camera.xmag = numberMember(*lens, "xmag", camera.xmag);
    camera.ymag = numberMember(*lens, "ymag", camera.ymag);
    return camera;
}

// Only translation, rotation and scale, nothing that folding would lose.
bool isPlainGpuInstancing(const json& instancing) {
    for (const auto& [key, value] : instancing.items())
        if (key != "attributes")
            return false;
    const json* attributes = member(instancing, "attributes");
    if (attributes == nullptr || !attributes->is_object())
        return false;
    for (const auto& [key, value] : attributes->items())
        if (key != "TRANSLATION" && key != "ROTATION" && key != "SCALE")
            return false;
    return true;
}

bool isPlainLeaf(const json& node) {
    for (const char* key : {"children", "skin", "camera", "extras", "weights"})
        if (const json* value = member(node, key); value != nullptr && !value->empty())
            return false;
    if (node.contains("skin") || node.contains("camera"))
        return false;
    const json* extensions = member(node, "extensions");
    if (extensions == nullptr)
        return true;
    for (const auto& [key, value] : extensions->items())
        if (key != kGpuInstancing || !isPlainGpuInstancing(value))
            return false;
    return true;
}

void flagFoldable(const ReadContext& context, const std::vector<TreeNode>& tree) {
    const json& document = context.document.json;
    std::vector<bool> needed = nodesOfOtherScenes(document);
    for (const json& skin : listOf(document, "skins")) {
        for (const json& joint : skin["joints"])
            needed[*asUnsigned(joint)] = true;
        if (const auto skeleton = unsignedMember(skin, "skeleton"))
            needed[*skeleton] = true;
    }
    const json& nodes = listOf(document, "nodes");
    for (const TreeNode& entry : tree) {
        Node& node = context.scene.nodes[entry.node];
        node.foldable = node.submesh != kNone && !node.animated && !needed[entry.node] &&
                        isPlainLeaf(nodes[entry.node]);
    }
}

// One of the instancing attributes as floats, or null if the file has none.
Result<AccessorPtr> readInstanceAttribute(const ReadContext& context,
                                          AccessorReader& accessors,
                                          const json& attributes,
                                          const char* semantic,
                                          std::uint8_t components) {
    const json* value = member(attributes, semantic);
    if (value == nullptr)
        return AccessorPtr();
    const std::optional<std::uint64_t> index = asUnsigned(*value);
    const std::size_t size = listOf(context.document.json, "accessors").size();
    if (!index || *index >= size)
        return badInput(std::string(semantic) + " is not one of the " + std::to_string(size) +
                        " accessors: re-export the file");
    Result<AccessorPtr> data = accessors.read(*index);
    if (data && (*data)->components != components)
        return badInput(std::string(semantic) + " does not have " + std::to_string(components) +
                        " components: re-export the file");
    return data;
}

glm::dvec4 elementAt(const Attribute& attribute, std::size_t row) {
    glm::dvec4 value(0.0);
    for (std::size_t c = 0; c < attribute.components; ++c)
        value[static_cast<int>(c)] = static_cast<double>(attributeValue(attribute, row, c));
    return value;
}

Attribute asAttribute(const AccessorData& data) {
    Attribute attribute;
    attribute.type = data.type;
    attribute.components = data.components;
    attribute.normalized = data.normalized;
    attribute.bytes = data.bytes;
    return attribute;
}

// Transforms of a node's GPU instances relative to the node.
Result<std::vector<glm::dmat4>>
readGpuInstances(const ReadContext& context, AccessorReader& accessors, const json& instancing) {
    const json* attributes = member(instancing, "attributes");
    if (attributes == nullptr || !attributes->is_object())
        return badInput("has no attributes: re-export the file");
    constexpr std::array<std::pair<const char*, std::uint8_t>, 3> kSemantics{
        {{"TRANSLATION", 3}, {"ROTATION", 4}, {"SCALE", 3}}};
    std::array<std::optional<Attribute>, 3> columns;
    std::optional<std::uint64_t> count;
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const auto& [semantic, components] = kSemantics[i];
        Result<AccessorPtr> data =
            readInstanceAttribute(context, accessors, *attributes, semantic, components);
        if (!data)
            return tl::make_unexpected(data.error());
        if (!*data)
            continue;
        if (count.value_or((*data)->count) != (*data)->count)
            return badInput(std::string(semantic) + " has " + std::to_string((*data)->count) +
                            " elements, others have " + std::to_string(*count) +
                            ": re-export the file");
        count = (*data)->count;
        columns[i] = asAttribute(**data);
    }
    std::vector<glm::dmat4> transforms(count.value_or(0));
    for (std::size_t row = 0; row < transforms.size(); ++row) {
        Trs trs;
        if (columns[0])
            trs.translation = glm::dvec3(elementAt(*columns[0], row));
        if (columns[1]) {
            const glm::dvec4 q = elementAt(*columns[1], row);
            trs.rotation = unitOrIdentity(glm::dquat(q.w, q.x, q.y, q.z));
        }
        if (columns[2])
            trs.scale = glm::dvec3(elementAt(*columns[2], row));
        transforms[row] = toMatrix(trs);
    }
    return transforms;
}

Result<void> addInstances(const ReadContext& context, AccessorReader& accessors, std::uint32_t n) {
    Scene& scene = context.scene;
    const Node& node = scene.nodes[n];
    const json* instancing = extension(listOf(context.document.json, "nodes")[n], kGpuInstancing);
    if (instancing == nullptr) {
        scene.instances.push_back({node.world, node.submesh, n, kNone});
        return {};
    }
    Result<std::vector<glm::dmat4>> transforms = readGpuInstances(context, accessors, *instancing);
    if (!transforms)
        return context.bad(nodeName(context, n) + ": " + kGpuInstancing + ": " +
                           transforms.error().message);
    for (std::uint32_t row = 0; row < transforms->size(); ++row) {
        scene.instances.push_back({node.world * (*transforms)[row], node.submesh, n, row});
        if (!isFinite(scene.instances.back().transform))
            return context.bad(nodeName(context, n) + ": transform of GPU instance " +
                               std::to_string(row) + " is not finite: re-export the file");
    }
    return {};
}

Result<void> placeNodes(const ReadContext& context, const std::vector<TreeNode>& tree) {
    const json& document = context.document.json;
    const json& nodes = listOf(document, "nodes");
    AnimationTargets targets = findAnimationTargets(document);
    for (const TreeNode& entry : tree) {
        Node& node = context.scene.nodes[entry.node];
        const json& source = nodes[entry.node];
        const std::optional<glm::dmat4> local = localTransform(source);
        if (!local)
            return context.bad(nodeName(context, entry.node) +
                               ": matrix has a perspective part: bake the transform and re-export");
        node.parent = entry.parent;
        node.world = *local;
        if (entry.parent != kNone) {
            node.world = context.scene.nodes[entry.parent].world * *local;
            if (targets.transform[entry.parent])
                targets.transform[entry.node] = true;
        }
        if (!isFinite(node.world))
            return context.bad(nodeName(context, entry.node) +
                               ": its transform is not finite: repair it and re-export");
        node.animated = targets.transform[entry.node] || targets.weights[entry.node];
        if (const auto camera = unsignedMember(source, "camera")) {
            node.camera = static_cast<std::uint32_t>(context.scene.cameras.size());
            context.scene.cameras.push_back(
                readCamera(listOf(document, "cameras")[*camera], node.world));
        }
    }
    return {};
}

} // namespace

Result<void> readNodes(const ReadContext& context, AccessorReader& accessors) {
    Result<std::vector<TreeNode>> tree = makeNodeTree(context);
    if (!tree)
        return tl::make_unexpected(tree.error());
    const json& nodes = listOf(context.document.json, "nodes");
    for (std::uint32_t n = 0; n < nodes.size(); ++n) {
        Node node;
        node.name = stringMember(nodes[n], "name");
        node.submesh = static_cast<std::uint32_t>(unsignedMember(nodes[n], "mesh").value_or(kNone));
        node.skin = static_cast<std::uint32_t>(unsignedMember(nodes[n], "skin").value_or(kNone));
        context.scene.nodes.push_back(std::move(node));
        context.document.node_of_node.push_back(n);
    }
    if (Result<void> placed = placeNodes(context, *tree); !placed)
        return placed;
    std::vector<std::uint32_t> drawn;
    for (const TreeNode& entry : *tree)
        if (context.scene.nodes[entry.node].submesh != kNone)
            drawn.push_back(entry.node);
    std::ranges::sort(drawn);
    for (const std::uint32_t node : drawn)
        if (Result<void> added = addInstances(context, accessors, node); !added)
            return added;
    std::ranges::stable_sort(context.scene.instances, {}, &Instance::submesh);
    flagFoldable(context, *tree);
    return {};
}

} // namespace lodestone
