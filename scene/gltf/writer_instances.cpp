#include "scene/gltf/writer_instances.h"

#include "scene/gltf/writer_references.h"
#include "scene/scene_builder.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <set>

namespace lodestone {

using nlohmann::json;

namespace {

// What a fold group costs in text beside its rows, roughly: a node and its accessors.
constexpr double kGroupNodeBytes = 60.0;
constexpr double kGroupAccessorBytes = 115.0;
// A node costs its text, its mesh, its braces and its number in the parent's list.
constexpr double kNodeExtraBytes = 22.0;
// Below this many rows a group inside a moving parent is not worth its node.
constexpr std::uint32_t kFewestRows = 4;

template <class T>
std::vector<std::byte> toBytes(const std::vector<T>& values) {
    std::vector<std::byte> bytes(values.size() * sizeof(T));
    if (!bytes.empty())
        std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}

std::string floatText(double value) {
    return fixedWidthNumber(static_cast<float>(value), 0);
}

class InstancePlanner {
public:
    InstancePlanner(ExportPlan& plan, json& document)
        : plan_(plan), scene_(plan.scene), document_(document) {}

    void planAll() {
        planRows();
        if (plan_.options.instancing == Instancing::Auto ||
            plan_.options.instancing == Instancing::Gpu)
            planFolds();
    }

    // Nodes that are not in the file and hang below no node.
    const std::vector<std::uint32_t>& addedRoots() const { return added_roots_; }

private:
    std::uint32_t planOf(std::uint32_t scene_node) const {
        return scene_.source->node_of_node[scene_node];
    }

    // Instances as the file has them: nodes, or rows of EXT_mesh_gpu_instancing.
    void planRows() {
        plan_.instances.resize(scene_.instances.size());
        std::map<std::uint32_t, std::uint32_t> group_of_node;
        for (std::uint32_t i = 0; i < scene_.instances.size(); ++i) {
            const Instance& instance = scene_.instances[i];
            InstancePlan& to = plan_.instances[i];
            to.node = planOf(instance.node);
            if (instance.gpu_index == kNone)
                continue;
            if (plan_.options.instancing == Instancing::Nodes) {
                to.node = addRowNode(instance);
                continue;
            }
            const auto [known, is_new] = group_of_node.try_emplace(
                instance.node, static_cast<std::uint32_t>(plan_.groups.size()));
            if (is_new)
                addFileGroup(instance);
            to.group = known->second;
            to.row = instance.gpu_index;
            GroupPlan& group = plan_.groups[to.group];
            group.rows = std::max(group.rows, to.row + 1);
        }
        for (const auto& [node, group] : group_of_node)
            fillFileGroup(plan_.groups[group], node);
    }

    void addFileGroup(const Instance& instance) {
        GroupPlan group;
        group.submesh = instance.submesh;
        group.node = planOf(instance.node);
        plan_.nodes[group.node].group = static_cast<std::uint32_t>(plan_.groups.size());
        plan_.groups.push_back(std::move(group));
    }

    // The group's rows are known.
    void fillFileGroup(GroupPlan& group, std::uint32_t scene_node) {
        const json& entry = document_["nodes"][planOf(scene_node)];
        for (const auto& [name, number] :
             entry["extensions"][kGpuInstancing]["attributes"].items()) {
            const json& accessor = scene_.source->json["accessors"][number.get<std::size_t>()];
            PackedElements packed = resolvedElements(*scene_.source, accessor, group.rows);
            GroupAttribute attribute;
            attribute.key = dumpJson(name) + ":";
            json format = json::object();
            for (const char* key : {"componentType", "type", "normalized"})
                if (accessor.contains(key))
                    format[key] = accessor[key];
            attribute.format = dumpMembers(format);
            attribute.row_bytes = packed.element_bytes;
            attribute.bytes = std::move(packed.bytes);
            group.attributes.push_back(std::move(attribute));
        }
    }

    // A row as a node of its own, below the node that held it.
    std::uint32_t addRowNode(const Instance& instance) {
        const Node& holder = scene_.nodes[instance.node];
        NodePlan node;
        glm::dmat4 local = glm::inverse(holder.world) * instance.transform;
        node.parent = planOf(instance.node);
        if (!std::isfinite(local[0][0]) || glm::determinant(holder.world) == 0.0) {
            local = instance.transform;
            node.parent = kNone;
        }
        node.mesh = plan_.submeshes[instance.submesh].mesh;
        Trs trs;
        node.body = Fragment(decompose(local, trs) ? trsText(trs) : matrixText(local));
        const auto index = static_cast<std::uint32_t>(plan_.nodes.size());
        if (node.parent == kNone)
            added_roots_.push_back(index);
        plan_.nodes.push_back(std::move(node));
        return index;
    }

    static std::string trsText(const Trs& trs) {
        const glm::dquat& q = trs.rotation;
        const glm::dvec3& t = trs.translation;
        const glm::dvec3& s = trs.scale;
        std::string text = "\"translation\":[" + floatText(t.x) + "," + floatText(t.y) + "," +
                           floatText(t.z) + "]";
        if (glm::abs(q.w) < 1.0)
            text += ",\"rotation\":[" + floatText(q.x) + "," + floatText(q.y) + "," +
                    floatText(q.z) + "," + floatText(q.w) + "]";
        if (s != glm::dvec3(1.0))
            text +=
                ",\"scale\":[" + floatText(s.x) + "," + floatText(s.y) + "," + floatText(s.z) + "]";
        return text;
    }

    static std::string matrixText(const glm::dmat4& matrix) {
        std::string text = "\"matrix\":[";
        for (int i = 0; i < 16; ++i)
            text += (i == 0 ? "" : ",") + floatText(matrix[i / 4][i % 4]);
        return text + "]";
    }

    // Where an instance's transform can be a row: at the root, or below a parent that moves.
    struct Place {
        std::uint32_t parent = kNone;
        Trs trs;
    };

    bool findPlace(std::uint32_t i, Place& place) const {
        const Instance& instance = scene_.instances[i];
        const Node& node = scene_.nodes[instance.node];
        const std::uint32_t node_plan = planOf(instance.node);
        if (!node.foldable || instance.gpu_index != kNone || plan_.nodes[node_plan].always)
            return false;
        if (!node.animated && decompose(instance.transform, place.trs))
            return true;
        if (node.parent == kNone)
            return false;
        place.parent = planOf(node.parent);
        return decompose(glm::inverse(scene_.nodes[node.parent].world) * instance.transform,
                         place.trs);
    }

    void planFolds() {
        for (std::uint32_t s = 0; s < plan_.submeshes.size(); ++s) {
            const InstanceRange range = plan_.submeshes[s].range;
            std::map<std::uint32_t, std::vector<std::uint32_t>> by_parent;
            std::map<std::uint32_t, std::vector<Trs>> transforms;
            for (std::uint32_t i = range.begin; i < range.end; ++i) {
                Place place;
                if (!findPlace(i, place))
                    continue;
                by_parent[place.parent].push_back(i);
                transforms[place.parent].push_back(place.trs);
            }
            for (const auto& [parent, members] : by_parent)
                if (members.size() >= (parent == kNone ? 2 : kFewestRows))
                    addFold(s, parent, members, transforms[parent]);
        }
    }

    void addFold(std::uint32_t submesh,
                 std::uint32_t parent,
                 const std::vector<std::uint32_t>& members,
                 const std::vector<Trs>& transforms) {
        const auto group_index = static_cast<std::uint32_t>(plan_.groups.size());
        GroupPlan group;
        group.submesh = submesh;
        group.node = static_cast<std::uint32_t>(plan_.nodes.size());
        group.rows = static_cast<std::uint32_t>(members.size());
        group.folded = true;
        group.attributes = foldAttributes(transforms);
        NodePlan node;
        node.parent = parent;
        node.mesh = plan_.submeshes[submesh].mesh;
        node.group = group_index;
        if (parent == kNone)
            added_roots_.push_back(group.node);
        plan_.nodes.push_back(std::move(node));
        for (std::uint32_t row = 0; row < members.size(); ++row) {
            InstancePlan& to = plan_.instances[members[row]];
            to.group = group_index;
            to.row = row;
            to.named = !scene_.nodes[scene_.instances[members[row]].node].name.empty();
        }
        plan_.groups.push_back(std::move(group));
    }

    // Rotations and scales are left out where all of them are the identity.
    static std::vector<GroupAttribute> foldAttributes(const std::vector<Trs>& transforms) {
        std::vector<glm::vec4> rotations;
        std::vector<glm::vec3> scales;
        std::vector<glm::vec3> translations;
        for (const Trs& trs : transforms) {
            const glm::dquat& q = trs.rotation;
            rotations.emplace_back(q.x, q.y, q.z, q.w);
            scales.emplace_back(trs.scale);
            translations.emplace_back(trs.translation);
        }
        const auto isTurn = [](const glm::vec4& q) { return q != glm::vec4(0, 0, 0, 1); };
        const auto isScale = [](const glm::vec3& s) { return s != glm::vec3(1.0f); };
        const std::string vec3 = "\"componentType\":5126,\"type\":\"VEC3\"";
        std::vector<GroupAttribute> attributes;
        attributes.push_back({"\"TRANSLATION\":", vec3, 12, toBytes(translations)});
        if (std::ranges::any_of(rotations, isTurn))
            attributes.push_back({"\"ROTATION\":",
                                  "\"componentType\":5126,\"type\":\"VEC4\"",
                                  16,
                                  toBytes(rotations)});
        if (std::ranges::any_of(scales, isScale))
            attributes.push_back({"\"SCALE\":", vec3, 12, toBytes(scales)});
        return attributes;
    }

    ExportPlan& plan_;
    const Scene& scene_;
    json& document_;
    std::vector<std::uint32_t> added_roots_;
};

// From how many kept instances rows are smaller than nodes, by average sizes.
void estimate(ExportPlan& plan, SubmeshPlan& submesh) {
    const std::uint32_t count = submesh.range.size();
    if (count == 0)
        return;
    std::set<std::uint32_t> groups;
    std::uint32_t outside = 0;
    CountingSink sink;
    const std::vector<std::uint32_t> indices(plan.nodes.size(), 0);
    for (std::uint32_t i = submesh.range.begin; i < submesh.range.end; ++i) {
        const InstancePlan& instance = plan.instances[i];
        if (instance.group == kNone)
            ++outside;
        else
            groups.insert(instance.group);
        plan.nodes[instance.node].body.emit(sink, indices);
    }
    submesh.node_bytes = static_cast<double>(sink.sizeBytes()) / count + kNodeExtraBytes;
    if (groups.size() == 1 && outside == 0)
        submesh.sole_group = *groups.begin();
    for (const std::uint32_t g : groups) {
        double row_bytes = 0.0;
        for (const GroupAttribute& attribute : plan.groups[g].attributes) {
            row_bytes += static_cast<double>(attribute.row_bytes);
            submesh.fold_fixed_bytes += kGroupAccessorBytes;
        }
        submesh.fold_fixed_bytes += kGroupNodeBytes;
        submesh.row_bytes = std::max(submesh.row_bytes, row_bytes);
    }
    if (groups.empty())
        return;
    if (plan.options.instancing == Instancing::Gpu)
        submesh.fold_from = 1;
    else if (submesh.node_bytes > submesh.row_bytes)
        submesh.fold_from = static_cast<std::uint32_t>(
            std::ceil(submesh.fold_fixed_bytes / (submesh.node_bytes - submesh.row_bytes)));
}

} // namespace

std::vector<std::uint32_t> planInstances(ExportPlan& plan, json& document) {
    InstancePlanner planner(plan, document);
    planner.planAll();
    return planner.addedRoots();
}

void estimateInstances(ExportPlan& plan) {
    for (SubmeshPlan& submesh : plan.submeshes)
        estimate(plan, submesh);
}

} // namespace lodestone
