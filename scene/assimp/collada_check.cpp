#include "scene/assimp/precheck.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace lodestone {

namespace {

constexpr std::size_t kMaxDepth = 1000; // of elements, and of the unfolded node tree
constexpr double kMaxUnfolded = 4e6;    // nodes
constexpr std::size_t kNowhere = ~std::size_t{0};

struct Tag {
    std::string_view name; // without namespace prefix
    std::string_view attributes;
    bool closes = false;
    bool opens = false; // both: <tag/>
};

// The tags of an XML text in order; comments, CDATA and processing instructions are passed over.
class TagReader {
public:
    explicit TagReader(std::string_view xml) : xml_(xml) {}

    // False at the end. Errors: entity declarations.
    Result<bool> next(Tag& tag);

private:
    bool skip(std::string_view opening, std::string_view closing);

    std::string_view xml_;
    std::size_t at_ = 0;
};

bool TagReader::skip(std::string_view opening, std::string_view closing) {
    if (!xml_.substr(at_).starts_with(opening))
        return false;
    const std::size_t end = xml_.find(closing, at_ + opening.size());
    at_ = end == std::string_view::npos ? xml_.size() : end + closing.size();
    return true;
}

Result<bool> TagReader::next(Tag& tag) {
    while ((at_ = xml_.find('<', at_)) != std::string_view::npos) {
        if (xml_.substr(at_).starts_with("<!ENTITY"))
            return badInput("declares XML entities, which are not read; save it without them");
        if (skip("<!--", "-->") || skip("<![CDATA[", "]]>") || skip("<?", "?>"))
            continue;
        if (xml_.substr(at_).starts_with("<!")) {
            ++at_; // what a DOCTYPE holds is looked at, too
            continue;
        }
        std::size_t end = at_ + 1;
        for (char quote = 0; end < xml_.size() && (quote != 0 || xml_[end] != '>'); ++end) {
            if (quote == 0 && (xml_[end] == '"' || xml_[end] == '\''))
                quote = xml_[end];
            else if (xml_[end] == quote)
                quote = 0;
        }
        std::string_view body = xml_.substr(at_ + 1, end - at_ - 1);
        at_ = end;
        tag.closes = body.starts_with('/') || body.ends_with('/');
        tag.opens = !body.starts_with('/');
        if (!tag.opens)
            body.remove_prefix(1);
        const std::size_t name_end = std::min(body.find_first_of(" \t\r\n/"), body.size());
        tag.name = body.substr(0, name_end);
        tag.name.remove_prefix(tag.name.find(':') + 1); // npos + 1 is 0
        tag.attributes = body.substr(name_end);
        return true;
    }
    return false;
}

std::string attributeOf(const Tag& tag, std::string_view name) {
    const std::string_view text = tag.attributes;
    for (std::size_t at = text.find(name); at != std::string_view::npos;
         at = text.find(name, at + 1)) {
        const bool starts = at > 0 && std::string_view(" \t\r\n").find(text[at - 1]) != kNowhere;
        const std::size_t equals = text.find_first_not_of(" \t\r\n", at + name.size());
        if (!starts || equals == kNowhere || text[equals] != '=')
            continue;
        const std::size_t quote = text.find_first_of("\"'", equals);
        if (quote == kNowhere)
            break;
        const std::size_t end = text.find(text[quote], quote + 1);
        return std::string(text.substr(quote + 1, end - quote - 1));
    }
    return {};
}

// The nodes of the file, and which nodes each one draws: children and instanced ones.
struct NodeGraph {
    struct Link {
        std::size_t from = 0;
        std::string to;
    };

    std::vector<std::string> names;
    std::vector<std::vector<std::size_t>> drawn;
    std::vector<Link> links;
    std::map<std::string, std::size_t> library;             // id of <library_nodes>' children
    std::multimap<std::string, std::size_t> by_id_and_name; // of all

    std::size_t add(const Tag& tag, std::size_t parent, bool in_library) {
        const std::size_t index = drawn.size();
        drawn.emplace_back();
        if (parent != kNowhere)
            drawn[parent].push_back(index);
        const std::string id = attributeOf(tag, "id");
        const std::string name = attributeOf(tag, "name");
        names.push_back(id.empty() ? name : id);
        if (in_library)
            library[id] = index;
        by_id_and_name.emplace(id, index);
        if (name != id)
            by_id_and_name.emplace(name, index);
        return index;
    }

    // Finds the targets as assimp does: the library's node, else any node of that id or name.
    void resolveLinks() {
        for (const Link& link : links) {
            const auto exact = library.find(link.to);
            if (exact != library.end()) {
                drawn[link.from].push_back(exact->second);
                continue;
            }
            const auto [first, last] = by_id_and_name.equal_range(link.to);
            std::for_each(
                first, last, [&](const auto& entry) { drawn[link.from].push_back(entry.second); });
        }
    }
};

Result<NodeGraph> readNodes(std::string_view xml) {
    struct Open {
        std::string_view name;
        std::size_t node = kNowhere; // the innermost node
    };

    NodeGraph graph;
    std::vector<Open> open;
    TagReader reader(xml);
    Tag tag;
    for (;;) {
        const Result<bool> more = reader.next(tag);
        if (!more)
            return tl::unexpected(more.error());
        if (!*more)
            break;
        if (tag.opens) {
            const Open parent = open.empty() ? Open{} : open.back();
            Open now{tag.name, parent.node};
            if (tag.name == "node")
                now.node = graph.add(tag, parent.node, parent.name == "library_nodes");
            else if (tag.name == "instance_node" && parent.node != kNowhere) {
                const std::string url = attributeOf(tag, "url");
                if (url.starts_with('#'))
                    graph.links.push_back({parent.node, url.substr(1)});
            }
            open.push_back(now);
            if (open.size() > kMaxDepth)
                return badInput("nests more than " + std::to_string(kMaxDepth) +
                                " elements; flatten the hierarchy and export again");
        }
        if (tag.closes && !open.empty())
            open.pop_back();
    }
    graph.resolveLinks();
    return graph;
}

// Depth-first over the graph without recursion: each node's unfolded size, once all it draws is
// known. A node met again while it is open contains itself.
Result<void> checkUnfolding(const NodeGraph& graph) {
    enum class State : std::uint8_t { New, Open, Done };

    struct Visit {
        std::size_t node = 0;
        std::size_t next = 0; // of what it draws
    };

    std::vector<State> state(graph.drawn.size(), State::New);
    std::vector<double> unfolded(graph.drawn.size(), 1.0);
    std::vector<std::size_t> depth(graph.drawn.size(), 1);
    for (std::size_t root = 0; root < graph.drawn.size(); ++root) {
        if (state[root] != State::New)
            continue;
        std::vector<Visit> open{{root, 0}};
        state[root] = State::Open;
        while (!open.empty()) {
            const std::size_t node = open.back().node;
            if (open.back().next == graph.drawn[node].size()) {
                state[node] = State::Done;
                open.pop_back();
                for (const std::size_t child : graph.drawn[node]) {
                    unfolded[node] += unfolded[child];
                    depth[node] = std::max(depth[node], depth[child] + 1);
                }
                if (unfolded[node] > kMaxUnfolded || depth[node] > kMaxDepth)
                    return badInput("node '" + graph.names[node] +
                                    "' unfolds to too many or too deeply nested nodes; simplify "
                                    "the hierarchy and export again");
                continue;
            }
            const std::size_t child = graph.drawn[node][open.back().next++];
            if (state[child] == State::Open)
                return badInput("node '" + graph.names[child] +
                                "' contains an instance of itself; remove the cycle");
            if (state[child] == State::New) {
                state[child] = State::Open;
                open.push_back({child, 0});
            }
        }
    }
    return {};
}

} // namespace

Result<void> checkCollada(std::string_view xml) {
    if (xml.starts_with("\xFF\xFE") || xml.starts_with("\xFE\xFF") ||
        xml.substr(0, 64).find('\0') != std::string_view::npos)
        return badInput("is not encoded in UTF-8; save it as UTF-8");
    const Result<NodeGraph> graph = readNodes(xml);
    if (!graph)
        return tl::unexpected(graph.error());
    return checkUnfolding(*graph);
}

} // namespace lodestone
