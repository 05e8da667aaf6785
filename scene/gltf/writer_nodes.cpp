#include "scene/gltf/writer_nodes.h"

#include "scene/gltf/writer_references.h"

#include <algorithm>

namespace lodestone {

using nlohmann::json;

namespace {

std::vector<std::uint32_t> nodeList(const json& owner, const char* key, std::size_t node_count) {
    std::vector<std::uint32_t> nodes;
    if (const auto found = owner.find(key); found != owner.end() && found->is_array())
        for (const json& node : *found)
            if (node.is_number_unsigned() && node.get<std::uint64_t>() < node_count)
                nodes.push_back(node.get<std::uint32_t>());
    return nodes;
}

std::size_t drawnScene(const json& document) {
    const auto found = document.find("scene");
    return found != document.end() && found->is_number_unsigned() ? found->get<std::size_t>() : 0;
}

// Nodes of the scene that is drawn; the others are passed on as they are.
std::vector<bool> drawnNodes(const json& document) {
    const std::size_t count = document.contains("nodes") ? document["nodes"].size() : 0;
    std::vector<bool> drawn(count, false);
    const std::size_t scene = drawnScene(document);
    if (!document.contains("scenes") || scene >= document["scenes"].size())
        return drawn;
    std::vector<std::uint32_t> open = nodeList(document["scenes"][scene], "nodes", count);
    while (!open.empty()) {
        const std::uint32_t node = open.back();
        open.pop_back();
        if (drawn[node])
            continue;
        drawn[node] = true;
        for (const std::uint32_t child : nodeList(document["nodes"][node], "children", count))
            open.push_back(child);
    }
    return drawn;
}

// Rows of a node that no LOD touches.
void carryRows(json& instancing, CarriedData& carried) {
    if (const auto attributes = instancing.find("attributes"); attributes != instancing.end())
        for (json& number : *attributes)
            if (const auto index = carried.accessor(number.get<std::uint32_t>()); index != kNone)
                number = index;
}

NodePlan nodePlan(ExportPlan& plan, json& entry, bool is_wanted, bool is_drawn) {
    NodePlan node;
    const bool has_children = entry.contains("children") && !entry["children"].empty();
    const bool has_mesh = entry.contains("mesh");
    node.always = is_wanted || !is_drawn || entry.contains("camera") || entry.contains("extras") ||
                  (!has_children && !has_mesh);
    if (has_mesh)
        node.mesh = entry["mesh"].get<std::uint32_t>();
    node.always_draws = has_mesh && !is_drawn;
    if (node.always_draws)
        plan.meshes[node.mesh].wanted = true;
    if (const auto found = entry.find("extensions"); found != entry.end()) {
        json extensions = *found;
        if (!node.always_draws)
            extensions.erase(kGpuInstancing);
        else if (extensions.contains(kGpuInstancing))
            carryRows(extensions[kGpuInstancing], plan.carried);
        node.extensions = Fragment(dumpMembers(extensions));
        node.always |= !extensions.empty();
    }
    json with_mesh = json::object();
    for (const char* key : {"skin", "weights"})
        if (entry.contains(key))
            with_mesh[key] = entry[key];
    node.body = Fragment(dumpMembers(nodeBody(entry)));
    node.with_mesh = dumpMembers(with_mesh);
    return node;
}

void listChildren(ExportPlan& plan) {
    const std::size_t count = plan.nodes.size();
    plan.first_child.assign(count + 1, 0);
    for (const NodePlan& node : plan.nodes)
        if (node.parent != kNone)
            ++plan.first_child[node.parent + 1];
    for (std::size_t n = 0; n < count; ++n)
        plan.first_child[n + 1] += plan.first_child[n];
    std::vector<std::uint32_t> next(plan.first_child.begin(), plan.first_child.end() - 1);
    plan.children.resize(plan.first_child.back());
    for (std::uint32_t n = 0; n < count; ++n)
        if (plan.nodes[n].parent != kNone)
            plan.children[next[plan.nodes[n].parent]++] = n;
}

void orderBottomUp(ExportPlan& plan) {
    std::vector<std::uint32_t>& order = plan.bottom_up;
    for (std::uint32_t n = 0; n < plan.nodes.size(); ++n)
        if (plan.nodes[n].parent == kNone)
            order.push_back(n);
    for (std::size_t at = 0; at < order.size(); ++at) {
        const std::uint32_t node = order[at];
        for (std::uint32_t c = plan.first_child[node]; c < plan.first_child[node + 1]; ++c)
            order.push_back(plan.children[c]);
    }
    std::ranges::reverse(order);
}

// What every layout asks of every node, apart from what only the JSON needs.
void listRoles(ExportPlan& plan) {
    for (std::uint32_t n = 0; n < plan.nodes.size(); ++n) {
        const NodePlan& node = plan.nodes[n];
        plan.parents.push_back(node.parent);
        if (node.always)
            plan.always.push_back(n);
        if (node.always_draws)
            plan.always_draws.push_back(n);
    }
}

} // namespace

json nodeBody(const json& entry) {
    json body = entry;
    for (const char* key : {"children", "mesh", "extensions", "skin", "weights"})
        body.erase(key);
    return body;
}

void planNodes(ExportPlan& plan, json& document, const std::set<std::uint32_t>& wanted) {
    const std::vector<bool> drawn = drawnNodes(document);
    const auto count = static_cast<std::uint32_t>(drawn.size());
    for (std::uint32_t n = 0; n < count; ++n)
        plan.nodes.push_back(nodePlan(plan, document["nodes"][n], wanted.contains(n), drawn[n]));
    for (std::uint32_t n = 0; n < count; ++n)
        for (const std::uint32_t child : nodeList(document["nodes"][n], "children", count))
            plan.nodes[child].parent = n;
}

void planScenes(ExportPlan& plan,
                const json& document,
                const std::vector<std::uint32_t>& added_roots) {
    json list = document.contains("scenes") ? document["scenes"] : json::array();
    if (list.empty())
        list.push_back(json::object());
    const std::size_t node_count = document.contains("nodes") ? document["nodes"].size() : 0;
    for (std::size_t s = 0; s < list.size(); ++s) {
        ScenePlan to;
        to.nodes = nodeList(list[s], "nodes", node_count);
        if (s == drawnScene(document))
            to.nodes.insert(to.nodes.end(), added_roots.begin(), added_roots.end());
        list[s].erase("nodes");
        to.rest = Fragment(dumpMembers(list[s]));
        plan.scenes.push_back(std::move(to));
    }
    listChildren(plan);
    orderBottomUp(plan);
    listRoles(plan);
}

} // namespace lodestone
