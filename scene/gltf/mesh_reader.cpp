#include "scene/gltf/mesh_reader.h"

#include "scene/gltf/primitive_reader.h"

#include <map>

namespace lodestone {

using nlohmann::json;

namespace {

// Everything a primitive's geometry is made of; equal keys, equal geometry.
std::string geometryKey(const json& primitive) {
    std::string key = primitive["attributes"].dump();
    for (const char* name : {"indices", "mode", "targets"})
        if (const json* value = member(primitive, name))
            key += std::string(name) + value->dump();
    return key;
}

// How many different primitives draw from each POSITION accessor.
std::map<std::uint64_t, std::size_t> countPositionUsers(const json& meshes) {
    std::map<std::uint64_t, std::map<std::string, bool>> users;
    for (const json& mesh : meshes)
        for (const json& primitive : mesh["primitives"])
            if (const auto position = unsignedMember(primitive["attributes"], "POSITION"))
                users[*position].emplace(geometryKey(primitive), true);
    std::map<std::uint64_t, std::size_t> counts;
    for (const auto& [position, keys] : users)
        counts[position] = keys.size();
    return counts;
}

// Takes meshes without primitives out of the document and renumbers what nodes refer to.
void dropEmptyMeshes(json& document) {
    json& meshes = document["meshes"];
    std::vector<std::uint32_t> new_index(meshes.size(), kNone);
    json kept = json::array();
    for (std::size_t m = 0; m < meshes.size(); ++m)
        if (!meshes[m]["primitives"].empty()) {
            new_index[m] = static_cast<std::uint32_t>(kept.size());
            kept.push_back(std::move(meshes[m]));
        }
    meshes = std::move(kept);
    if (!document.contains("nodes"))
        return;
    for (json& node : document["nodes"]) {
        const std::optional<std::uint64_t> mesh = unsignedMember(node, "mesh");
        if (!mesh)
            continue;
        if (new_index[*mesh] != kNone)
            node["mesh"] = new_index[*mesh];
        else
            for (const char* name : {"mesh", "skin", "weights"})
                node.erase(name);
    }
}

class MeshReader {
public:
    MeshReader(const ReadContext& context, AccessorReader& accessors)
        : context_(context), accessors_(accessors),
          position_users_(countPositionUsers(listOf(context.document.json, "meshes"))) {}

    Result<void> readMesh(json& mesh, std::size_t mesh_index) {
        Submesh submesh;
        submesh.name = stringMember(mesh, "name");
        json kept = json::array();
        for (std::size_t p = 0; p < mesh["primitives"].size(); ++p) {
            json& source = mesh["primitives"][p];
            const std::string name =
                label("mesh", mesh_index, submesh.name) + " primitive " + std::to_string(p);
            Result<std::optional<Primitive>> primitive = readShared(source, name);
            if (!primitive)
                return primitive.error().kind == ErrorKind::BadInput
                           ? context_.bad(name + ": " + primitive.error().message)
                           : tl::make_unexpected(primitive.error());
            if (!*primitive)
                continue;
            dropCompression(source);
            submesh.primitives.push_back(std::move(**primitive));
            kept.push_back(std::move(source));
        }
        mesh["primitives"] = std::move(kept);
        if (submesh.primitives.empty())
            return {};
        const auto index = static_cast<std::uint32_t>(context_.scene.submeshes.size());
        context_.document.mesh_of_submesh.push_back(index);
        context_.scene.submeshes.push_back(std::move(submesh));
        return {};
    }

private:
    struct Shared {
        GeometryPtr geometry;
        PrimitiveData description; // its geometry is moved into the above
    };

    Result<std::optional<Primitive>> readShared(const json& source, const std::string& name) {
        if (context_.job.stopRequested())
            return cancelled();
        const std::string key = geometryKey(source);
        auto found = geometries_.find(key);
        if (found == geometries_.end()) {
            Result<std::optional<PrimitiveData>> data =
                readPrimitive(source, accessors_, name, context_.scene.notes);
            if (!data)
                return tl::make_unexpected(data.error());
            if (!*data)
                return std::nullopt;
            const std::uint64_t position = *unsignedMember(source["attributes"], "POSITION");
            if (position_users_.at(position) > 1)
                dropUnusedVertices((*data)->geometry);
            Shared shared;
            shared.geometry = std::make_shared<const Geometry>(std::move((*data)->geometry));
            shared.description = std::move(**data);
            found = geometries_.emplace(key, std::move(shared)).first;
        }
        Primitive primitive;
        primitive.geometry = found->second.geometry;
        primitive.mode = found->second.description.mode;
        primitive.position_type = found->second.description.position_type;
        primitive.position_normalized = found->second.description.position_normalized;
        if (const auto material = unsignedMember(source, "material"))
            primitive.material = static_cast<std::uint32_t>(*material);
        return primitive;
    }

    // What was read is in the scene; the compressed twin would go stale.
    static void dropCompression(json& primitive) {
        if (extension(primitive, "KHR_draco_mesh_compression") != nullptr)
            primitive["extensions"].erase("KHR_draco_mesh_compression");
    }

    const ReadContext& context_;
    AccessorReader& accessors_;
    std::map<std::uint64_t, std::size_t> position_users_;
    std::map<std::string, Shared> geometries_;
};

} // namespace

Result<void> readMeshes(const ReadContext& context, AccessorReader& accessors) {
    json& document = context.document.json;
    if (listOf(document, "meshes").empty())
        return context.bad("has no meshes, so there is nothing to draw: export it with geometry");
    MeshReader reader(context, accessors);
    json& meshes = document["meshes"];
    for (std::size_t m = 0; m < meshes.size(); ++m) {
        if (Result<void> read = reader.readMesh(meshes[m], m); !read)
            return read;
        context.job.report(0.2 + 0.7 * static_cast<double>(m) / static_cast<double>(meshes.size()));
    }
    dropEmptyMeshes(document);
    return {};
}

} // namespace lodestone
