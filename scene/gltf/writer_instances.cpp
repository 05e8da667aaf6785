#include "scene/gltf/writer_instances.h"

#include "scene/gltf/instance_rows.h"
#include "scene/gltf/writer_nodes.h"
#include "scene/gltf/writer_references.h"
#include "scene/morton.h"

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
// Share of the scene's diagonal that a rounded rotation may move a point by.
constexpr double kRotationTolerance = 0x1p-18;
// The same where a third of the submesh's triangles is left: simplifying has moved them farther.
constexpr double kCoarseRotationTolerance = 0x1p-10;
// Below this many rows a group inside a moving parent is not worth its node.
constexpr std::uint32_t kFewestRows = 4;

std::string floatText(double value) {
    return shortestNumber(static_cast<float>(value));
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
        if (plan_.options.compression == Compression::Meshopt)
            for (std::uint32_t g = 0; g < plan_.groups.size(); ++g)
                sortRows(g);
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
            to.node = plan_.drawn_by[planOf(instance.node)];
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

    // The group's rows are known. Without a grid they stay as the file has them, but for rotations
    // that fewer bits hold as well.
    void fillFileGroup(GroupPlan& group, std::uint32_t scene_node) {
        const json& entry = document_["nodes"][planOf(scene_node)];
        const bool regrids = plan_.grids[group.submesh].step > 0.0;
        std::vector<RowColumn> columns;
        for (const auto& [name, number] :
             entry["extensions"][kGpuInstancing]["attributes"].items()) {
            const json& accessor = scene_.source->json["accessors"][number.get<std::size_t>()];
            PackedElements packed = resolvedElements(*scene_.source, accessor, group.rows);
            const bool transforms = name == "TRANSLATION" || name == "ROTATION" || name == "SCALE";
            if (transforms)
                columns.push_back({name, asAttribute(accessor, packed)});
            if (transforms && (regrids || isFloatRotation(name, accessor)))
                continue;
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
        std::vector<Trs> rows = rowTransforms(columns, group.rows);
        double holder = largestScale(scene_.nodes[scene_node].world);
        if (regrids)
            holder *= regrid(group, rows, entry, holder);
        else if (std::ranges::any_of(columns, [](const RowColumn& column) {
                     return column.name == "ROTATION" &&
                            column.values.type == ComponentType::Float32;
                 }))
            group.attributes.push_back(rotationAttribute(rows, reachOf(group.submesh, holder)));
        planCoarse(group, rows, holder);
    }

    // Filters of packed rows do better than bytes.
    void planCoarse(GroupPlan& group, std::span<const Trs> rows, double node_scale) const {
        constexpr double kWider = kCoarseRotationTolerance / kRotationTolerance;
        const auto has = [&](std::string_view key, std::size_t row_bytes) {
            return std::ranges::any_of(group.attributes, [&](const GroupAttribute& attribute) {
                return attribute.key == key && attribute.row_bytes >= row_bytes;
            });
        };
        if (plan_.options.compression == Compression::Meshopt ||
            !has("\"TRANSLATION\":", sizeof(glm::vec3)) || !has("\"ROTATION\":", 8))
            return;
        RowReach reach = reachOf(group.submesh, node_scale);
        reach.tolerance *= kWider;
        group.coarse = coarseAttributes(rows, reach);
    }

    static bool isFloatRotation(const std::string& name, const json& accessor) {
        return name == "ROTATION" && accessor["componentType"] == 5126;
    }

    // The rows of a node of the file for positions on a grid. Returns the scale that went from them
    // into the node.
    double regrid(GroupPlan& group, std::vector<Trs>& rows, const json& entry, double holder) {
        for (Trs& row : rows)
            row = composed(row, plan_.grids[group.submesh]);
        double common = 1.0;
        if (!plan_.nodes[group.node].always && !entry.contains("matrix")) {
            common = takeCommonScale(rows);
            if (common != 1.0)
                plan_.nodes[group.node].body = Fragment(dumpMembers(scaledBody(entry, common)));
        }
        std::vector<GroupAttribute> transforms =
            rowAttributes(rows, reachOf(group.submesh, holder * common));
        group.attributes.insert(group.attributes.end(),
                                std::make_move_iterator(transforms.begin()),
                                std::make_move_iterator(transforms.end()));
        return common;
    }

    static json scaledBody(const json& entry, double factor) {
        json body = nodeBody(entry);
        json scale = body.value("scale", json::array({1.0, 1.0, 1.0}));
        for (json& s : scale)
            s = shortNumber(s.get<double>() * factor);
        body["scale"] = std::move(scale);
        return body;
    }

    static Attribute asAttribute(const json& accessor, const PackedElements& packed) {
        Attribute attribute;
        attribute.type = static_cast<ComponentType>(accessor["componentType"].get<int>());
        attribute.components = accessor["type"] == "VEC4" ? 4 : 3;
        attribute.normalized = accessor.value("normalized", false);
        attribute.bytes = packed.bytes;
        return attribute;
    }

    static Trs composed(const Trs& row, const PositionGrid& grid) {
        return {row.translation + row.rotation * (row.scale * grid.offset),
                row.rotation,
                row.scale * grid.step};
    }

    // How far a transform stretches along an axis, at most; 1 where it has none.
    static double largestScale(const glm::dmat4& transform) {
        double largest = 0.0;
        for (int column = 0; column < 3; ++column)
            largest = std::max(largest, glm::length(glm::dvec3(transform[column])));
        return largest > 0.0 ? largest : 1.0;
    }

    // What rotations of the submesh's rows may move; a row's scale holds the grid's step, or a
    // scale of the nodes around them does. The distance is that from the submesh's own origin, also
    // where the grid has its origin in the middle: LODs that grew have another grid, and what is
    // stored must not depend on that.
    RowReach reachOf(std::uint32_t submesh, double node_scale) const {
        const PositionGrid& grid = plan_.grids[submesh];
        const Bounds box = localBounds(scene_.submeshes[submesh]);
        const glm::dvec3 far = glm::max(glm::abs(box.min), glm::abs(box.max));
        const double step = grid.step > 0.0 ? grid.step : 1.0;
        return {glm::length(far) / step,
                plan_.diagonal * kRotationTolerance / node_scale,
                (box.center() - grid.offset) / step,
                0.5 * box.diagonal() / step};
    }

    // A row as a node of its own, below the node that held it.
    std::uint32_t addRowNode(const Instance& instance) {
        const Node& holder = scene_.nodes[instance.node];
        NodePlan node;
        const glm::dmat4 world = worldOf(instance);
        glm::dmat4 local = glm::inverse(holder.world) * world;
        node.parent = planOf(instance.node);
        if (!std::isfinite(local[0][0]) || glm::determinant(holder.world) == 0.0) {
            local = world;
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

    // Of what is stored, in the world.
    glm::dmat4 worldOf(const Instance& instance) const {
        const PositionGrid& grid = plan_.grids[instance.submesh];
        return grid.step > 0.0 ? instance.transform * gridMatrix(grid) : instance.transform;
    }

    bool findPlace(std::uint32_t i, Place& place) const {
        const Instance& instance = scene_.instances[i];
        const Node& node = scene_.nodes[instance.node];
        const std::uint32_t node_plan = planOf(instance.node);
        if (!node.foldable || instance.gpu_index != kNone || plan_.nodes[node_plan].always)
            return false;
        if (!node.animated && decompose(worldOf(instance), place.trs))
            return true;
        if (node.parent == kNone)
            return false;
        place.parent = planOf(node.parent);
        return decompose(glm::inverse(scene_.nodes[node.parent].world) * worldOf(instance),
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
                 std::vector<Trs>& transforms) {
        const auto group_index = static_cast<std::uint32_t>(plan_.groups.size());
        GroupPlan group;
        group.submesh = submesh;
        group.node = static_cast<std::uint32_t>(plan_.nodes.size());
        group.rows = static_cast<std::uint32_t>(members.size());
        group.folded = true;
        NodePlan node;
        const double common = takeCommonScale(transforms);
        if (common != 1.0) {
            const std::string text = floatText(common);
            node.body = Fragment("\"scale\":[" + text + "," + text + "," + text + "]");
        }
        const std::uint32_t holder =
            scene_.nodes[scene_.instances[members.front()].node].parent; // of all members
        const double around =
            parent == kNone ? common : common * largestScale(scene_.nodes[holder].world);
        group.attributes = rowAttributes(transforms, reachOf(submesh, around));
        planCoarse(group, transforms, around);
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

    // Rows in an order that packs well.
    void sortRows(std::uint32_t g) {
        GroupPlan& group = plan_.groups[g];
        const auto found = std::ranges::find(
            group.attributes, std::string("\"TRANSLATION\":"), &GroupAttribute::key);
        if (found == group.attributes.end() || found->row_bytes != sizeof(glm::vec3))
            return;
        std::vector<glm::dvec3> translations;
        for (std::size_t row = 0; row < group.rows; ++row) {
            glm::vec3 at;
            std::memcpy(&at, found->bytes.data() + row * sizeof at, sizeof at);
            translations.emplace_back(at);
        }
        const std::vector<std::uint32_t> order = mortonOrder(translations);
        for (GroupAttribute& attribute : group.attributes) {
            const std::vector<std::byte> old = attribute.bytes;
            for (std::size_t to = 0; to < order.size(); ++to)
                std::memcpy(attribute.bytes.data() + to * attribute.row_bytes,
                            old.data() + order[to] * attribute.row_bytes,
                            attribute.row_bytes);
        }
        std::vector<std::uint32_t> place(order.size());
        for (std::uint32_t to = 0; to < order.size(); ++to)
            place[order[to]] = to;
        const InstanceRange range = plan_.submeshes[group.submesh].range;
        for (std::uint32_t i = range.begin; i < range.end; ++i)
            if (plan_.instances[i].group == g)
                plan_.instances[i].row = place[plan_.instances[i].row];
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
        const GroupPlan& group = plan.groups[g];
        for (std::size_t a = 0; a < group.attributes.size(); ++a) {
            row_bytes += static_cast<double>(group.stored(a, true).row_bytes);
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
