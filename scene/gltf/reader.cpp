#include "scene/gltf/reader.h"

#include "scene/gltf/accessor_reader.h"
#include "scene/gltf/container.h"
#include "scene/gltf/material_reader.h"
#include "scene/gltf/mesh_reader.h"
#include "scene/gltf/meshopt_reader.h"
#include "scene/gltf/node_reader.h"
#include "scene/gltf/resources.h"
#include "scene/gltf/validate.h"
#include "scene/outliers.h"

#include <algorithm>

namespace lodestone {

using nlohmann::json;

namespace {

constexpr std::array<std::string_view, 9> kUnderstood{"EXT_mesh_gpu_instancing",
                                                      "KHR_mesh_quantization",
                                                      "KHR_texture_transform",
                                                      "KHR_materials_unlit",
                                                      "KHR_materials_emissive_strength",
                                                      "KHR_texture_basisu",
                                                      "EXT_texture_webp",
                                                      "KHR_draco_mesh_compression",
                                                      "EXT_meshopt_compression"};

void noteRequiredExtensions(const ReadContext& context) {
    for (const json& required : listOf(context.document.json, "extensionsRequired")) {
        const std::string name = required.get<std::string>();
        if (std::ranges::find(kUnderstood, name) == kUnderstood.end())
            context.note("the file requires " + name.substr(0, 60) +
                         ", which is kept but not shown");
    }
}

void eraseName(json& document, const char* list_name, std::string_view name) {
    if (!document.contains(list_name))
        return;
    json& list = document[list_name];
    json kept = json::array();
    for (json& element : list)
        if (element != name)
            kept.push_back(std::move(element));
    if (kept.empty())
        document.erase(list_name);
    else
        list = std::move(kept);
}

// What was compressed is in the scene now and leaves it as the export is told to.
void forgetCompression(json& document) {
    for (const char* name : {"KHR_draco_mesh_compression", "EXT_meshopt_compression"}) {
        eraseName(document, "extensionsUsed", name);
        eraseName(document, "extensionsRequired", name);
    }
}

Result<void> checkDrawable(const ReadContext& context) {
    if (context.scene.instances.empty())
        return context.bad("no node of the scene draws a mesh, so there is nothing to draw: "
                           "export it with geometry");
    return {};
}

Result<void> readAll(const ReadContext& context, GltfContainer& container) {
    if (Result<void> valid = validateDocument(context.document.json); !valid)
        return context.bad(valid.error().message);
    if (Result<void> read = readBuffers(context, container); !read)
        return read;
    if (Result<void> undone = decompressMeshopt(context); !undone)
        return undone;
    context.job.report(0.2);
    noteRequiredExtensions(context);
    AccessorReader accessors(context.document);
    for (const auto& step : {readMeshes, readNodes})
        if (Result<void> read = step(context, accessors); !read)
            return read;
    for (const auto& step : {readMaterials, readImages, checkDrawable})
        if (Result<void> read = step(context); !read)
            return read;
    forgetCompression(context.document.json);
    noteOutliers(context.scene);
    return {};
}

} // namespace

Result<ScenePtr> readGltf(const std::filesystem::path& path, const JobContext& job) {
    const Result<std::vector<std::byte>> bytes = readFileBytes(path);
    if (!bytes)
        return tl::make_unexpected(bytes.error());
    return readGltfBytes(*bytes, path, job);
}

Result<ScenePtr> readGltfBytes(const std::vector<std::byte>& bytes,
                               const std::filesystem::path& path,
                               const JobContext& job) {
    const std::string file = path.filename().string();
    Result<GltfContainer> container = readContainer(bytes, file);
    if (!container)
        return tl::make_unexpected(container.error());
    auto scene = std::make_shared<Scene>();
    auto document = std::make_shared<SourceDocument>();
    scene->name = file;
    scene->file_bytes = container->file_bytes;
    document->json = std::move(container->json);
    document->folder = path.parent_path();
    const ReadContext context{file, *document, *scene, job};
    try {
        if (Result<void> read = readAll(context, *container); !read)
            return tl::make_unexpected(read.error());
    } catch (const json::exception& e) {
        return context.bad("JSON has an unexpected shape (" + std::string(e.what()).substr(0, 120) +
                           "): re-export the file");
    } catch (const std::bad_alloc&) {
        return context.bad("needs more memory than there is: close other programs or split it");
    }
    scene->source = std::move(document);
    job.report(1.0);
    return ScenePtr(std::move(scene));
}

} // namespace lodestone
