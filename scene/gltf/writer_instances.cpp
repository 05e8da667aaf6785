#include "scene/gltf/writer_instances.h"

#include "scene/gltf/writer_references.h"
#include "scene/scene_builder.h"

#include <algorithm>
#include <cstring>

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
    InstancePlanner(ExportPlan& plan, json& document, const std::set<std::uint32_t>& wanted)
        : plan_(plan), scene_(plan.scene), document_(document), wanted_(wanted) {}

    void planAll() {
        findFirstOccurrences();
        for (std::uint32_t j = 0; j < first_of_json_.size(); ++j)
            plan_.nodes.push_back(nodePlan(j));
        addRepeatedNodes();
        linkParents();
        planRows();
        if (plan_.options.instancing != Instancing::Nodes)
            planFolds();
        planScenes();
        listChildren();
        orderBottomUp();
        for (std::uint32_t s = 0; s < plan_.submeshes.size(); ++s)
            estimate(s);
    }

private:
    std::size_t jsonNodeCount() const {
        return document_.contains("nodes") ? document_["nodes"].size() : 0;
    }

    void findFirstOccurrences() {
        first_of_json_.assign(jsonNodeCount(), kNone);
        const std::vector<std::uint32_t>& json_of = scene_.source->node_of_node;
        for (std::uint32_t n = 0; n < json_of.size(); ++n)
            if (first_of_json_[json_of[n]] == kNone)
                first_of_json_[json_of[n]] = n;
        plan_of_node_.assign(json_of.size(), kNone);
    }

    // A node of the file; one that the drawn scene does not reach stays whatever the LOD.
    NodePlan nodePlan(std::uint32_t json_node) {
        json entry = document_["nodes"][json_node];
        NodePlan node;
        const bool has_children = entry.contains("children") && !entry["children"].empty();
        node.always = wanted_.contains(json_node) || entry.contains("camera") ||
                      entry.contains("extras") || (!has_children && !entry.contains("mesh"));
        if (first_of_json_[json_node] == kNone) {
            node.always = true;
            node.always_draws = entry.contains("mesh") && !entry["mesh"].is_null();
        } else {
            plan_of_node_[first_of_json_[json_node]] = json_node;
        }
        if (entry.contains("mesh"))
            node.mesh = entry["mesh"].get<std::uint32_t>();
        if (node.always_draws)
            plan_.meshes[node.mesh].wanted = true;
        if (const auto extensions = entry.find("extensions"); extensions != entry.end()) {
            if (!node.always_draws)
                extensions->erase(kGpuInstancing);
            else if (extensions->contains(kGpuInstancing))
                carryRows((*extensions)[kGpuInstancing]);
            node.extensions = Fragment(dumpMembers(*extensions));
            node.always |= !extensions->empty();
        }
        json with_mesh = json::object();
        for (const char* key : {"skin", "weights"})
            if (entry.contains(key))
                with_mesh[key] = entry[key];
        node.with_mesh = dumpMembers(with_mesh);
        for (const char* key : {"children", "mesh", "extensions", "skin", "weights"})
            entry.erase(key);
        node.body = Fragment(dumpMembers(entry));
        return node;
    }

    // Rows of a node that no LOD touches.
    void carryRows(json& instancing) {
        if (!instancing.contains("attributes"))
            return;
        for (json& number : instancing["attributes"])
            if (const auto carried = plan_.carried.accessor(number.get<std::uint32_t>());
                carried != kNone)
                number = carried;
    }

    // A node that the file lists under several parents is written once for each.
    void addRepeatedNodes() {
        const std::vector<std::uint32_t>& json_of = scene_.source->node_of_node;
        for (std::uint32_t n = 0; n < json_of.size(); ++n) {
            if (plan_of_node_[n] != kNone)
                continue;
            plan_of_node_[n] = static_cast<std::uint32_t>(plan_.nodes.size());
            plan_.nodes.push_back(plan_.nodes[json_of[n]]);
        }
    }

    void linkParents() {
        for (std::uint32_t n = 0; n < scene_.nodes.size(); ++n)
            if (scene_.nodes[n].parent != kNone)
                plan_.nodes[plan_of_node_[n]].parent = plan_of_node_[scene_.nodes[n].parent];
        const json empty = json::array();
        for (std::uint32_t j = 0; j < first_of_json_.size(); ++j) {
            if (first_of_json_[j] != kNone || !document_["nodes"][j].contains("children"))
                continue;
            for (const json& child : document_["nodes"][j]["children"]) {
                const auto index = child.get<std::size_t>();
                if (index < first_of_json_.size() && first_of_json_[index] == kNone)
                    plan_.nodes[index].parent = j;
            }
        }
    }

    // Instances as the file has them: nodes, or rows of EXT_mesh_gpu_instancing.
    void planRows() {
        plan_.instances.resize(scene_.instances.size());
        std::map<std::uint32_t, std::uint32_t> group_of_node;
        for (std::uint32_t i = 0; i < scene_.instances.size(); ++i) {
            const Instance& instance = scene_.instances[i];
            InstancePlan& to = plan_.instances[i];
            to.node = plan_of_node_[instance.node];
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
    }

    void addFileGroup(const Instance& instance) {
        GroupPlan group;
        group.submesh = instance.submesh;
        group.node = plan_of_node_[instance.node];
        plan_.nodes[group.node].group = static_cast<std::uint32_t>(plan_.groups.size());
        const json& entry = document_["nodes"][scene_.source->node_of_node[instance.node]];
        for (const auto& [name, number] :
             entry["extensions"][kGpuInstancing]["attributes"].items()) {
            json accessor = scene_.source->json["accessors"][number.get<std::size_t>()];
            PackedElements packed = packElements(*scene_.source, accessor);
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
        plan_.groups.push_back(std::move(group));
    }

    // A row as a node of its own, below the node that held it.
    std::uint32_t addRowNode(const Instance& instance) {
        const Node& holder = scene_.nodes[instance.node];
        NodePlan node;
        glm::dmat4 local = glm::inverse(holder.world) * instance.transform;
        node.parent = plan_of_node_[instance.node];
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
        const std::uint32_t node_plan = plan_of_node_[instance.node];
        if (!node.foldable || instance.gpu_index != kNone || plan_.nodes[node_plan].always)
            return false;
        if (!node.animated && decompose(instance.transform, place.trs))
            return true;
        if (node.parent == kNone)
            return false;
        place.parent = plan_of_node_[node.parent];
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

    void planScenes() {
        json list = document_.contains("scenes") ? document_["scenes"] : json::array();
        if (list.empty())
            list.push_back(json::object());
        const std::size_t drawn = document_.value("scene", std::size_t{0});
        for (std::size_t s = 0; s < list.size(); ++s) {
            ScenePlan to;
            if (s == drawn) {
                for (std::uint32_t n = 0; n < scene_.nodes.size(); ++n)
                    if (scene_.nodes[n].parent == kNone)
                        to.nodes.push_back(plan_of_node_[n]);
                to.nodes.insert(to.nodes.end(), added_roots_.begin(), added_roots_.end());
            } else if (list[s].contains("nodes")) {
                for (const json& node : list[s]["nodes"])
                    if (node.is_number_unsigned() && node.get<std::size_t>() < jsonNodeCount())
                        to.nodes.push_back(node.get<std::uint32_t>());
            }
            list[s].erase("nodes");
            to.rest = Fragment(dumpMembers(list[s]));
            plan_.scenes.push_back(std::move(to));
        }
    }

    void listChildren() {
        const std::size_t count = plan_.nodes.size();
        plan_.first_child.assign(count + 1, 0);
        for (const NodePlan& node : plan_.nodes)
            if (node.parent != kNone)
                ++plan_.first_child[node.parent + 1];
        for (std::size_t n = 0; n < count; ++n)
            plan_.first_child[n + 1] += plan_.first_child[n];
        std::vector<std::uint32_t> next(plan_.first_child.begin(), plan_.first_child.end() - 1);
        plan_.children.resize(plan_.first_child.back());
        for (std::uint32_t n = 0; n < count; ++n)
            if (plan_.nodes[n].parent != kNone)
                plan_.children[next[plan_.nodes[n].parent]++] = n;
    }

    void orderBottomUp() {
        std::vector<std::uint32_t>& order = plan_.bottom_up;
        for (std::uint32_t n = 0; n < plan_.nodes.size(); ++n)
            if (plan_.nodes[n].parent == kNone)
                order.push_back(n);
        for (std::size_t at = 0; at < order.size(); ++at)
            for (std::uint32_t c = plan_.first_child[order[at]];
                 c < plan_.first_child[order[at] + 1];
                 ++c)
                order.push_back(plan_.children[c]);
        std::ranges::reverse(order);
    }

    // From how many kept instances rows are smaller than nodes, by average sizes.
    void estimate(std::uint32_t s) {
        SubmeshPlan& submesh = plan_.submeshes[s];
        std::set<std::uint32_t> groups;
        double node_bytes = 0.0;
        std::uint32_t outside = 0;
        CountingSink sink;
        const std::vector<std::uint32_t> indices(plan_.nodes.size(), 0);
        for (std::uint32_t i = submesh.range.begin; i < submesh.range.end; ++i) {
            const InstancePlan& instance = plan_.instances[i];
            if (instance.group == kNone)
                ++outside;
            else
                groups.insert(instance.group);
            plan_.nodes[instance.node].body.emit(sink, indices);
        }
        const std::uint32_t count = submesh.range.size();
        if (count == 0)
            return;
        node_bytes = static_cast<double>(sink.sizeBytes()) / count + kNodeExtraBytes;
        submesh.node_bytes = node_bytes;
        if (groups.size() == 1 && outside == 0)
            submesh.sole_group = *groups.begin();
        for (const std::uint32_t g : groups) {
            double row_bytes = 0.0;
            for (const GroupAttribute& attribute : plan_.groups[g].attributes) {
                row_bytes += static_cast<double>(attribute.row_bytes);
                submesh.fold_fixed_bytes += kGroupAccessorBytes;
            }
            submesh.fold_fixed_bytes += kGroupNodeBytes;
            submesh.row_bytes = std::max(submesh.row_bytes, row_bytes);
        }
        if (groups.empty())
            return;
        if (plan_.options.instancing == Instancing::Gpu)
            submesh.fold_from = 1;
        else if (node_bytes > submesh.row_bytes)
            submesh.fold_from = static_cast<std::uint32_t>(
                std::ceil(submesh.fold_fixed_bytes / (node_bytes - submesh.row_bytes)));
    }

    ExportPlan& plan_;
    const Scene& scene_;
    json& document_;
    const std::set<std::uint32_t>& wanted_;
    std::vector<std::uint32_t> first_of_json_; // [json nodes] the first scene node made of it
    std::vector<std::uint32_t> plan_of_node_;  // [scene nodes] in ExportPlan::nodes
    std::vector<std::uint32_t> added_roots_;   // nodes that are not in the file
};

} // namespace

void planInstances(ExportPlan& plan, json& document, const std::set<std::uint32_t>& wanted) {
    InstancePlanner(plan, document, wanted).planAll();
}

} // namespace lodestone
