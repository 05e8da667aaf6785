#include "scene/gltf/node_tree.h"

#include <algorithm>

namespace lodestone {

using nlohmann::json;

namespace {

constexpr std::size_t kMaxCopies = 200'000;

std::vector<std::uint32_t> indicesOf(const json& object, std::string_view key) {
    std::vector<std::uint32_t> indices;
    if (const json* list = member(object, key))
        for (const json& element : *list)
            indices.push_back(static_cast<std::uint32_t>(*asUnsigned(element)));
    return indices;
}

// A node that is its own ancestor, if there is one. Depth-first with a stack of our own.
std::optional<std::uint32_t> findCycle(const std::vector<std::vector<std::uint32_t>>& children) {
    enum class Mark : std::uint8_t { New, Open, Done };
    std::vector<Mark> marks(children.size(), Mark::New);

    struct Frame {
        std::uint32_t node;
        std::size_t next_child;
    };

    std::vector<Frame> stack;
    for (std::uint32_t start = 0; start < children.size(); ++start) {
        if (marks[start] != Mark::New)
            continue;
        marks[start] = Mark::Open;
        stack.push_back({start, 0});
        while (!stack.empty()) {
            Frame& top = stack.back();
            if (top.next_child == children[top.node].size()) {
                marks[top.node] = Mark::Done;
                stack.pop_back();
                continue;
            }
            const std::uint32_t child = children[top.node][top.next_child++];
            if (marks[child] == Mark::Open)
                return child;
            if (marks[child] == Mark::New) {
                marks[child] = Mark::Open;
                stack.push_back({child, 0});
            }
        }
    }
    return std::nullopt;
}

std::size_t defaultScene(const json& document) {
    return unsignedMember(document, "scene").value_or(0);
}

void addScene(const ReadContext& context, const std::vector<std::vector<std::uint32_t>>& children) {
    std::vector<bool> is_child(children.size(), false);
    for (const std::vector<std::uint32_t>& list : children)
        for (const std::uint32_t child : list)
            is_child[child] = true;
    json roots = json::array();
    for (std::size_t n = 0; n < is_child.size(); ++n)
        if (!is_child[n])
            roots.push_back(n);
    context.document.json["scenes"] = json::array({json{{"nodes", std::move(roots)}}});
    context.document.json["scene"] = 0;
    context.note("the file has no scene: all its root nodes are shown");
}

// Walks the default scene and copies what is reached a second time.
class TreeMaker {
public:
    TreeMaker(json& document, std::vector<std::vector<std::uint32_t>> children)
        : nodes_(document["nodes"]), roots_(document["scenes"][defaultScene(document)]["nodes"]),
          children_(std::move(children)), reached_(children_.size(), false) {}

    // False if the copies get too many.
    bool run() {
        pushReversed(indicesOf(json{{"nodes", roots_}}, "nodes"), kNone);
        while (!stack_.empty()) {
            const Visit visit = stack_.back();
            stack_.pop_back();
            std::uint32_t node = visit.node;
            if (reached_[node]) {
                if (++copies_ > kMaxCopies)
                    return false;
                node = copy(visit);
            }
            reached_[node] = true;
            tree_.push_back({node, visit.parent});
            pushReversed(std::vector<std::uint32_t>(children_[node]), node);
        }
        return true;
    }

    std::size_t copies() const { return copies_; }

    std::vector<TreeNode> takeTree() { return std::move(tree_); }

private:
    struct Visit {
        std::uint32_t node;
        std::uint32_t parent;
        std::size_t slot; // in the parent's list of children
    };

    void pushReversed(const std::vector<std::uint32_t>& list, std::uint32_t parent) {
        for (std::size_t slot = list.size(); slot-- > 0;)
            stack_.push_back({list[slot], parent, slot});
    }

    std::uint32_t copy(const Visit& visit) {
        const auto index = static_cast<std::uint32_t>(nodes_.size());
        json twin = nodes_[visit.node];
        nodes_.push_back(std::move(twin));
        children_.push_back(std::vector<std::uint32_t>(children_[visit.node]));
        reached_.push_back(false);
        if (visit.parent == kNone)
            roots_[visit.slot] = index;
        else
            nodes_[visit.parent]["children"][visit.slot] = index;
        return index;
    }

    json& nodes_;
    json& roots_;
    std::vector<std::vector<std::uint32_t>> children_;
    std::vector<bool> reached_;
    std::vector<Visit> stack_;
    std::vector<TreeNode> tree_;
    std::size_t copies_ = 0;
};

} // namespace

Result<std::vector<TreeNode>> makeNodeTree(const ReadContext& context) {
    json& document = context.document.json;
    const json& nodes = listOf(document, "nodes");
    if (nodes.empty())
        return context.bad("has no nodes, so there is nothing to draw: export it with its scene");
    std::vector<std::vector<std::uint32_t>> children;
    children.reserve(nodes.size());
    for (const json& node : nodes)
        children.push_back(indicesOf(node, "children"));
    if (const std::optional<std::uint32_t> node = findCycle(children))
        return context.bad(label("node", *node, stringMember(nodes[*node], "name")) +
                           " is its own ancestor: re-export the file");
    if (listOf(document, "scenes").empty())
        addScene(context, children);
    json& scene = document["scenes"][defaultScene(document)];
    if (!scene.contains("nodes") || scene["nodes"].empty())
        return context.bad("scene " + std::to_string(defaultScene(document)) +
                           " has no nodes, so there is nothing to draw: export it with its nodes");
    TreeMaker maker(document, std::move(children));
    if (!maker.run())
        return context.bad("nodes have so many parents that they unfold to more than " +
                           std::to_string(kMaxCopies) + " copies: re-export the file");
    if (maker.copies() != 0)
        context.note(std::to_string(maker.copies()) +
                     " nodes with several parents were copied, one for each parent");
    return maker.takeTree();
}

std::vector<bool> nodesOfOtherScenes(const json& document) {
    const json& nodes = listOf(document, "nodes");
    const json& scenes = listOf(document, "scenes");
    std::vector<bool> reached(nodes.size(), false);
    std::vector<std::uint32_t> stack;
    for (std::size_t s = 0; s < scenes.size(); ++s) {
        if (s == defaultScene(document))
            continue;
        stack = indicesOf(scenes[s], "nodes");
        while (!stack.empty()) {
            const std::uint32_t node = stack.back();
            stack.pop_back();
            if (reached[node])
                continue;
            reached[node] = true;
            const std::vector<std::uint32_t> list = indicesOf(nodes[node], "children");
            stack.insert(stack.end(), list.begin(), list.end());
        }
    }
    return reached;
}

} // namespace lodestone
