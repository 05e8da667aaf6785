#include "scene/expansion.h"
#include "scene/gltf/source_document.h"
#include "scene/gltf/writer_references.h"

#include <algorithm>
#include <charconv>
#include <numeric>

namespace lodestone {

using nlohmann::json;

namespace {

class DocumentExpander {
public:
    DocumentExpander(Expansion& expansion, const Scene& scene)
        : expansion_(expansion), scene_(scene), skeleton_(*expansion.skeleton),
          document_(std::make_shared<SourceDocument>(*scene.source)) {
        for (const char* list : {"nodes", "meshes"})
            if (!document_->json.contains(list))
                document_->json[list] = json::array();
    }

    void expand() {
        detachMergedMeshes();
        renumberMeshes();
        dropEmptyNodes();
        addMerged();
    }

    void extend() {
        skeleton_.nodes = scene_.nodes;
        skeleton_.instances = scene_.instances;
        expansion_.new_index.resize(scene_.instances.size());
        std::iota(expansion_.new_index.begin(), expansion_.new_index.end(), 0U);
        addMerged();
    }

private:
    json& nodes() { return document_->json["nodes"]; }

    std::vector<std::uint32_t> childrenOf(std::uint32_t node) {
        std::vector<std::uint32_t> children;
        if (const auto found = nodes()[node].find("children"); found != nodes()[node].end())
            for (const json& child : *found)
                children.push_back(child.get<std::uint32_t>());
        return children;
    }

    // A node draws merged instances or others, never both: the node decides.
    void detachMergedMeshes() {
        emptied_.assign(nodes().size(), false);
        for (std::size_t i = 0; i < scene_.instances.size(); ++i) {
            if (!expansion_.merges[i])
                continue;
            const std::uint32_t n = scene_.source->node_of_node[scene_.instances[i].node];
            json& node = nodes()[n];
            emptied_[n] = true;
            node.erase("mesh");
            node.erase("weights");
            if (const auto extensions = node.find("extensions"); extensions != node.end()) {
                extensions->erase(kGpuInstancing);
                if (extensions->empty())
                    node.erase("extensions");
            }
        }
    }

    // Meshes that something still draws.
    void renumberMeshes() {
        json& root = document_->json;
        const std::size_t count = root.contains("meshes") ? root["meshes"].size() : 0;
        std::vector<bool> kept(count, false);
        for (const json& node : nodes())
            if (const auto mesh = node.find("mesh"); mesh != node.end())
                kept[mesh->get<std::size_t>()] = true;
        for (const std::uint32_t s : expansion_.apart)
            kept[scene_.source->mesh_of_submesh[s]] = true;
        json meshes = json::array();
        std::vector<std::uint32_t> number(count, kNone);
        for (std::size_t m = 0; m < count; ++m)
            if (kept[m]) {
                number[m] = static_cast<std::uint32_t>(meshes.size());
                meshes.push_back(std::move(root["meshes"][m]));
            }
        for (json& node : nodes())
            if (const auto mesh = node.find("mesh"); mesh != node.end())
                *mesh = number[mesh->get<std::size_t>()];
        document_->mesh_of_submesh.clear();
        for (const std::uint32_t s : expansion_.apart)
            document_->mesh_of_submesh.push_back(number[scene_.source->mesh_of_submesh[s]]);
        root["meshes"] = std::move(meshes);
    }

    // A mesh for each group.
    void addMergedMeshes() {
        json& meshes = document_->json["meshes"];
        for (std::size_t s = expansion_.first_merged; s < skeleton_.submeshes.size(); ++s) {
            const Submesh& submesh = skeleton_.submeshes[s];
            json primitive = json::object();
            if (submesh.primitives[0].material != kNone)
                primitive["material"] = submesh.primitives[0].material;
            json mesh{{"primitives", json::array({primitive})}};
            if (!submesh.name.empty())
                mesh["name"] = submesh.name;
            document_->mesh_of_submesh.push_back(static_cast<std::uint32_t>(meshes.size()));
            meshes.push_back(std::move(mesh));
        }
    }

    // Nodes that lost what they drew, and parents that are left without children by that.
    void dropEmptyNodes() {
        const std::vector<bool> dropped = findEmptyNodes();
        std::vector<std::uint32_t> number(dropped.size(), kNone);
        std::uint32_t next = 0;
        for (std::size_t n = 0; n < dropped.size(); ++n)
            if (!dropped[n])
                number[n] = next++;
        renumberReferences(number);
        json kept = json::array();
        for (std::size_t n = 0; n < dropped.size(); ++n)
            if (!dropped[n])
                kept.push_back(std::move(nodes()[n]));
        nodes() = std::move(kept);
        keepSceneNodes(number);
    }

    std::vector<bool> findEmptyNodes() {
        const std::size_t count = nodes().size();
        std::vector<bool> wanted(count, false);
        ReferenceVisitor visitor;
        visitor.node = [&](json& value) {
            if (value.get<std::uint64_t>() < count)
                wanted[value.get<std::size_t>()] = true;
        };
        visitor.node_pointer = [&](json& value) {
            if (const std::uint32_t node = pointedNode(value); node < count)
                wanted[node] = true;
        };
        visitor.accessor = visitor.buffer_view = [](json&) {};
        visitReferences(document_->json, visitor);
        std::vector<std::uint32_t> parent(count, kNone);
        std::vector<std::uint32_t> child_count(count, 0);
        std::vector<std::uint32_t> open;
        for (std::uint32_t n = 0; n < count; ++n) {
            for (const std::uint32_t child : childrenOf(n))
                parent[child] = n;
            child_count[n] = static_cast<std::uint32_t>(childrenOf(n).size());
            if (emptied_[n])
                open.push_back(n);
        }
        std::vector<bool> dropped(count, false);
        while (!open.empty()) {
            const std::uint32_t n = open.back();
            open.pop_back();
            if (dropped[n] || wanted[n] || child_count[n] > 0 || hasDuty(nodes()[n]))
                continue;
            dropped[n] = true;
            if (parent[n] != kNone && --child_count[parent[n]] == 0)
                open.push_back(parent[n]);
        }
        return dropped;
    }

    static bool hasDuty(const json& node) {
        return node.contains("mesh") || node.contains("camera") || node.contains("skin") ||
               node.contains("extras") || node.contains("extensions");
    }

    static std::uint32_t pointedNode(const std::string& pointer) {
        constexpr std::string_view kNodes = "/nodes/";
        std::uint32_t node = kNone;
        if (pointer.starts_with(kNodes))
            std::from_chars(pointer.data() + kNodes.size(), pointer.data() + pointer.size(), node);
        return node;
    }

    static void
    renumberList(json& owner, const char* key, const std::vector<std::uint32_t>& number) {
        const auto found = owner.find(key);
        if (found == owner.end())
            return;
        json list = json::array();
        for (const json& node : *found)
            if (const auto n = node.get<std::size_t>(); n < number.size() && number[n] != kNone)
                list.push_back(number[n]);
        if (list.empty())
            owner.erase(key);
        else
            *found = std::move(list);
    }

    void renumberReferences(const std::vector<std::uint32_t>& number) {
        ReferenceVisitor visitor;
        visitor.node = [&](json& value) {
            if (const auto n = value.get<std::size_t>(); n < number.size())
                value = number[n];
        };
        visitor.node_pointer = [&](json& value) {
            const std::string text = value;
            const std::uint32_t node = pointedNode(text);
            if (node >= number.size())
                return;
            const std::size_t rest = text.find('/', std::string_view("/nodes/").size());
            value = "/nodes/" + std::to_string(number[node]) +
                    (rest == std::string::npos ? "" : text.substr(rest));
        };
        visitor.accessor = visitor.buffer_view = [](json&) {};
        visitReferences(document_->json, visitor);
        for (json& node : nodes())
            renumberList(node, "children", number);
        if (document_->json.contains("scenes"))
            for (json& scene : document_->json["scenes"])
                renumberList(scene, "nodes", number);
    }

    // The Scene's own nodes and the instances that stay apart.
    void keepSceneNodes(const std::vector<std::uint32_t>& number) {
        std::vector<std::uint32_t> new_submesh(scene_.submeshes.size(), kNone);
        for (std::uint32_t s = 0; s < expansion_.apart.size(); ++s)
            new_submesh[expansion_.apart[s]] = s;
        std::vector<std::uint32_t> new_node(scene_.nodes.size(), kNone);
        document_->node_of_node.clear();
        for (std::uint32_t n = 0; n < scene_.nodes.size(); ++n) {
            const std::uint32_t in_document = scene_.source->node_of_node[n];
            if (number[in_document] == kNone)
                continue;
            new_node[n] = static_cast<std::uint32_t>(skeleton_.nodes.size());
            Node node = scene_.nodes[n];
            if (emptied_[in_document] || node.submesh == kNone)
                node.submesh = kNone;
            else
                node.submesh = new_submesh[node.submesh];
            node.foldable = node.foldable && node.submesh != kNone;
            skeleton_.nodes.push_back(std::move(node));
            document_->node_of_node.push_back(number[in_document]);
        }
        for (Node& node : skeleton_.nodes)
            if (node.parent != kNone)
                node.parent = new_node[node.parent];
        expansion_.new_index.assign(scene_.instances.size(), kNone);
        for (std::size_t i = 0; i < scene_.instances.size(); ++i) {
            if (expansion_.merges[i])
                continue;
            Instance instance = scene_.instances[i];
            instance.submesh = new_submesh[instance.submesh];
            instance.node = new_node[instance.node];
            expansion_.new_index[i] = static_cast<std::uint32_t>(skeleton_.instances.size());
            skeleton_.instances.push_back(instance);
        }
    }

    void addMerged() {
        addMergedMeshes();
        addMergedNodes();
        skeleton_.source = std::move(document_);
    }

    void addMergedNodes() {
        json& root = document_->json;
        const auto found = root.find("scene");
        const std::size_t drawn = found != root.end() ? found->get<std::size_t>() : 0;
        for (auto s = expansion_.first_merged; s < skeleton_.submeshes.size(); ++s) {
            const auto in_document = static_cast<std::uint32_t>(nodes().size());
            json entry{{"mesh", document_->mesh_of_submesh[s]}};
            Node node;
            node.name = skeleton_.submeshes[s].name;
            node.submesh = s;
            if (!node.name.empty())
                entry["name"] = node.name;
            nodes().push_back(std::move(entry));
            root["scenes"][drawn]["nodes"].push_back(in_document);
            const auto index = static_cast<std::uint32_t>(skeleton_.nodes.size());
            skeleton_.nodes.push_back(std::move(node));
            skeleton_.instances.push_back({glm::dmat4(1.0), s, index, kNone});
            document_->node_of_node.push_back(in_document);
        }
    }

    Expansion& expansion_;
    const Scene& scene_;
    Scene& skeleton_;
    std::shared_ptr<SourceDocument> document_;
    std::vector<bool> emptied_; // [nodes of the document] drew merged instances
};

} // namespace

void expandDocument(Expansion& expansion, const Scene& scene) {
    DocumentExpander(expansion, scene).expand();
}

void extendDocument(Expansion& expansion, const Scene& scene) {
    DocumentExpander(expansion, scene).extend();
}

} // namespace lodestone
