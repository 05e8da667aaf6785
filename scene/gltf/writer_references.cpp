#include "scene/gltf/writer_references.h"

#include <array>
#include <string>

namespace lodestone {

using nlohmann::json;

namespace {

constexpr std::array kUnvisited{kGpuInstancing, "EXT_meshopt_compression"};

void visitNumber(json& owner, const char* key, const std::function<void(json&)>& visit) {
    const auto found = owner.find(key);
    if (found != owner.end() && found->is_number_unsigned())
        visit(*found);
}

void visitNumbers(json& list, const std::function<void(json&)>& visit) {
    if (list.is_array())
        for (json& entry : list)
            if (entry.is_number_unsigned())
                visit(entry);
}

// Everything inside one extension.
void visitInside(json& value, const ReferenceVisitor& visitor) {
    if (value.is_array())
        for (json& entry : value)
            visitInside(entry, visitor);
    if (!value.is_object())
        return;
    visitNumber(value, "node", visitor.node);
    visitNumber(value, "accessor", visitor.accessor);
    for (const char* key : {"bufferView", "values", "arrayOffsets", "stringOffsets"})
        visitNumber(value, key, visitor.buffer_view);
    if (const auto nodes = value.find("nodes"); nodes != value.end())
        visitNumbers(*nodes, visitor.node);
    if (const auto pointer = value.find("pointer"); pointer != value.end() && pointer->is_string())
        visitor.node_pointer(*pointer);
    for (json& member : value)
        visitInside(member, visitor);
}

// Finds "extensions" objects at any depth.
void visitExtensions(json& value, const ReferenceVisitor& visitor) {
    if (value.is_array())
        for (json& entry : value)
            visitExtensions(entry, visitor);
    if (!value.is_object())
        return;
    for (auto& [key, member] : value.items()) {
        if (key == "extras")
            continue;
        if (key != "extensions" || !member.is_object()) {
            visitExtensions(member, visitor);
            continue;
        }
        for (auto& [name, extension] : member.items())
            if (std::ranges::find(kUnvisited, name) == kUnvisited.end())
                visitInside(extension, visitor);
    }
}

void visitAnimation(json& animation, const ReferenceVisitor& visitor) {
    for (json& sampler : animation["samplers"]) {
        visitNumber(sampler, "input", visitor.accessor);
        visitNumber(sampler, "output", visitor.accessor);
    }
    for (json& channel : animation["channels"])
        if (const auto target = channel.find("target"); target != channel.end())
            visitNumber(*target, "node", visitor.node);
}

void visitLodNodes(json& node, const ReferenceVisitor& visitor) {
    const json::json_pointer ids("/extensions/MSFT_lod/ids");
    if (node.contains(ids))
        visitNumbers(node[ids], visitor.node);
}

template <class Visit>
void forEach(json& document, const char* list, const Visit& visit) {
    const auto found = document.find(list);
    if (found == document.end() || !found->is_array())
        return;
    for (json& entry : *found)
        if (entry.is_object())
            visit(entry);
}

} // namespace

void visitReferences(json& document, const ReferenceVisitor& visitor) {
    forEach(document, "animations", [&](json& entry) { visitAnimation(entry, visitor); });
    forEach(document, "skins", [&](json& skin) {
        visitNumber(skin,
                    "inverseBindMatrices",
                    visitor.skin_accessor ? visitor.skin_accessor : visitor.accessor);
        visitNumber(skin, "skeleton", visitor.node);
        if (const auto joints = skin.find("joints"); joints != skin.end())
            visitNumbers(*joints, visitor.node);
    });
    forEach(document, "nodes", [&](json& node) { visitLodNodes(node, visitor); });
    for (auto& [key, member] : document.items())
        if (key != "accessors" && key != "bufferViews" && key != "buffers" && key != "extensions")
            visitExtensions(member, visitor);
    if (const auto root = document.find("extensions"); root != document.end())
        for (json& extension : *root)
            visitInside(extension, visitor);
}

void visitMeshAccessors(json& mesh, const ReferenceVisitor& visitor) {
    const auto visit_members = [&](json& object) {
        if (object.is_object())
            for (json& member : object)
                if (member.is_number_unsigned())
                    visitor.accessor(member);
    };
    forEach(mesh, "primitives", [&](json& primitive) {
        if (const auto found = primitive.find("attributes"); found != primitive.end())
            visit_members(*found);
        visitNumber(primitive, "indices", visitor.accessor);
        if (const auto targets = primitive.find("targets"); targets != primitive.end())
            for (json& target : *targets)
                visit_members(target);
    });
}

} // namespace lodestone
