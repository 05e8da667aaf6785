#include "scene/gltf/export_plan.h"

#include "scene/gltf/writer_instances.h"
#include "scene/gltf/writer_meshes.h"
#include "scene/gltf/writer_nodes.h"
#include "scene/gltf/writer_references.h"

#include <algorithm>
#include <array>
#include <set>

namespace lodestone {

using nlohmann::json;

namespace {

// Members that are rebuilt for every LOD.
constexpr std::array kRebuilt{"accessors",
                              "bufferViews",
                              "buffers",
                              "meshes",
                              "nodes",
                              "scenes",
                              "extensionsUsed",
                              "extensionsRequired"};
// Compression is undone by the import.
constexpr std::array kUndone{
    "KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression"};

std::vector<std::string> extensionList(const json& document, const char* key) {
    std::vector<std::string> names;
    if (const auto found = document.find(key); found != document.end() && found->is_array())
        for (const json& name : *found)
            if (name.is_string() &&
                std::ranges::find(kUndone, name.get<std::string>()) == kUndone.end())
                names.push_back(name);
    return names;
}

// Replaces references by what they are in the export, and tells which nodes are referred to.
std::set<std::uint32_t> rewriteReferences(json& document, CarriedData& carried) {
    std::set<std::uint32_t> wanted;
    const std::size_t node_count = document.contains("nodes") ? document["nodes"].size() : 0;
    const auto to_number = [](json& value, std::uint32_t number) {
        if (number != kNone)
            value = number;
    };
    ReferenceVisitor visitor;
    visitor.node = [&](json& value) {
        if (value.get<std::uint64_t>() >= node_count)
            return;
        const auto node = value.get<std::uint32_t>();
        wanted.insert(node);
        value = nodeReference(node);
    };
    visitor.node_pointer = [&](json& value) {
        constexpr std::string_view kNodes = "/nodes/";
        const std::string text = value;
        std::uint32_t node = 0;
        if (!text.starts_with(kNodes))
            return;
        const char* const digits = text.data() + kNodes.size();
        const auto parsed = std::from_chars(digits, text.data() + text.size(), node);
        if (parsed.ec != std::errc{} || node >= node_count)
            return;
        wanted.insert(node);
        value = std::string(kNodes) + nodePointer(node) + parsed.ptr;
    };
    visitor.accessor = [&](json& value) {
        to_number(value, carried.accessor(value.get<std::uint32_t>()));
    };
    visitor.skin_accessor = [&](json& value) {
        to_number(value, carried.accessor(value.get<std::uint32_t>(), CarriedData::Use::Skin));
    };
    visitor.buffer_view = [&](json& value) {
        to_number(value, carried.bufferView(value.get<std::uint32_t>()));
    };
    visitReferences(document, visitor);
    return wanted;
}

json headOf(const json& document) {
    json head = document;
    for (const char* key : kRebuilt)
        head.erase(key);
    // Lists must not be empty in glTF.
    for (auto member = head.begin(); member != head.end();)
        member = member->is_array() && member->empty() ? head.erase(member) : std::next(member);
    head["asset"]["generator"] = "Lodestone";
    if (!head["asset"].contains("version"))
        head["asset"]["version"] = "2.0";
    if (!head.contains("scene"))
        head["scene"] = 0;
    return head;
}

// Whether core glTF does not allow the type.
bool isQuantized(std::string_view semantic, const StoredType& stored) {
    if (stored.type == ComponentType::Float32)
        return false;
    const bool is_unsigned =
        stored.type == ComponentType::UInt8 || stored.type == ComponentType::UInt16;
    if (semantic.starts_with("\"TEXCOORD_"))
        return !is_unsigned || !stored.normalized;
    return semantic == "\"POSITION\":" || semantic == "\"NORMAL\":" || semantic == "\"TANGENT\":";
}

bool needsQuantization(const ExportPlan& plan) {
    for (const MeshPlan& mesh : plan.meshes)
        for (const PrimitivePlan& primitive : mesh.primitives)
            for (const StreamPlan& stream : primitive.streams)
                if (isQuantized(stream.key, stream.stored))
                    return true;
    return false;
}

void addName(std::vector<std::string>& names, const std::string& name) {
    if (std::ranges::find(names, name) == names.end())
        names.push_back(name);
}

} // namespace

ExportPlan::ExportPlan(const Scene& from,
                       const ExportOptions& with,
                       std::vector<PositionGrid> of_submeshes)
    : scene(from), options(with), grids(std::move(of_submeshes)), diagonal(boxDiagonal(from)),
      carried(*from.source) {
    json document = scene.source->json;
    const std::set<std::uint32_t> wanted = rewriteReferences(document, carried);
    drawn_by = applyGrids(document, scene, grids, wanted);
    planImages(*this, document);
    planMeshes(*this, document);
    planNodes(*this, document, wanted);
    planScenes(*this, document, planInstances(*this, document));
    estimateInstances(*this);
    extensions_used = extensionList(document, "extensionsUsed");
    extensions_required = extensionList(document, "extensionsRequired");
    if (needsQuantization(*this)) {
        addName(extensions_used, "KHR_mesh_quantization");
        addName(extensions_required, "KHR_mesh_quantization");
    }
    std::erase(extensions_used, kGpuInstancing);
    std::erase(extensions_required, kGpuInstancing);
    head = Fragment(dumpMembers(headOf(document)));
    carried.finish();
}

} // namespace lodestone
