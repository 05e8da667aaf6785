// Every real model out and in again, by every kind of instancing and both containers.
// LODESTONE_KEEP_EXPORTS=DIR keeps the files there, for a validator to look at.
#include "scene/export.h"
#include "scene/gltf/source_document.h"
#include "scene/import.h"
#include "tests/models_folder.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <string>
#include <unistd.h>

namespace lodestone {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using tests::modelsFolder;

struct Way {
    const char* name;
    const char* extension;
    Instancing instancing;
    Compression compression = Compression::None;
};

constexpr std::array kWays{
    Way{"auto", ".glb", Instancing::Auto},
    Way{"auto", ".gltf", Instancing::Auto},
    Way{"nodes", ".glb", Instancing::Nodes},
    Way{"nodes", ".gltf", Instancing::Nodes},
    Way{"gpu", ".glb", Instancing::Gpu},
    Way{"gpu", ".gltf", Instancing::Gpu},
    Way{"expand", ".glb", Instancing::Expand},
    Way{"expand", ".gltf", Instancing::Expand},
    Way{"quantize", ".glb", Instancing::Auto, Compression::Quantize},
    Way{"meshopt", ".glb", Instancing::Auto, Compression::Meshopt},
    Way{"meshopt", ".gltf", Instancing::Gpu, Compression::Meshopt},
    Way{"draco", ".glb", Instancing::Auto, Compression::Draco},
};

// Relative to the models' folder.
std::vector<std::string> relativeModelFiles() {
    std::vector<std::string> files;
    for (const fs::path& file : tests::modelFiles())
        files.push_back(file.lexically_relative(modelsFolder()).generic_string());
    return files;
}

std::string wordFor(std::string file) {
    std::ranges::replace_if(
        file, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
    return file;
}

std::uint64_t folderBytes(const fs::path& folder) {
    std::uint64_t bytes = 0;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
        bytes += entry.is_regular_file() ? entry.file_size() : 0;
    return bytes;
}

// A list of the document without what an export renumbers or moves.
json untouched(const Scene& scene, const char* list) {
    const auto found = scene.source->json.find(list);
    if (found == scene.source->json.end() || found->empty())
        return nullptr;
    json entries = *found;
    for (json& entry : entries) {
        for (const char* key : {"bufferView", "uri", "mimeType", "inverseBindMatrices"})
            entry.erase(key);
        for (const char* key : {"joints", "skeleton"})
            entry.erase(key);
        // An embedded image of a type beyond core glTF is named through its extension.
        for (const char* extension : {"KHR_texture_basisu", "EXT_texture_webp"})
            if (entry.contains("extensions") && entry["extensions"].contains(extension)) {
                entry["source"] = entry["extensions"][extension]["source"];
                entry.erase("extensions");
            }
        for (const char* key : {"samplers", "channels"})
            if (const auto parts = entry.find(key); parts != entry.end() && parts->is_array())
                for (json& part : *parts) {
                    part.erase("input");
                    part.erase("output");
                    if (part.contains("target"))
                        part["target"].erase("node");
                }
    }
    return entries;
}

class ModelsExport : public ::testing::TestWithParam<std::string> {
protected:
    void SetUp() override {
        const char* kept = std::getenv("LODESTONE_KEEP_EXPORTS");
        keep_ = kept != nullptr && *kept != '\0';
        const fs::path base =
            keep_ ? fs::path(kept)
                  : fs::temp_directory_path() / ("lodestone_models_" + std::to_string(::getpid()));
        folder_ = base / wordFor(GetParam());
        fs::remove_all(folder_);
    }

    void TearDown() override {
        if (!keep_)
            fs::remove_all(folder_.parent_path());
    }

    // The scene as it came back; null where the export failed.
    ScenePtr sent(const ScenePtr& scene, const Way& way) {
        const fs::path folder = folder_ / wordFor(way.name + std::string(way.extension));
        fs::create_directories(folder);
        const fs::path path = folder / (wordFor(GetParam()) + way.extension);
        const bool single = std::string_view(way.extension) == ".glb";
        const ExportOptions options{
            way.instancing, single ? Container::Glb : Container::Gltf, way.compression};
        const Lod lod = fullLod(*scene);
        const auto report = exportScene(*scene, lod, path, options);
        if (!report) {
            ADD_FAILURE() << report.error().message;
            return nullptr;
        }
        EXPECT_EQ(report->bytes, folderBytes(folder)) << path;
        const std::uint64_t predicted = ByteModel(scene, options).bytes(shapeOf(*scene, lod));
        const double allowed = isPacked(options) ? 0.1 * static_cast<double>(report->bytes) : 0;
        EXPECT_NEAR(static_cast<double>(predicted), static_cast<double>(report->bytes), allowed)
            << path;
        const auto again = importScene(path, {});
        if (!again) {
            ADD_FAILURE() << again.error().message;
            return nullptr;
        }
        return *again;
    }

    fs::path folder_;
    bool keep_ = false;
};

void expectSameShape(const Scene& before, const Scene& after, const Way& way) {
    const SceneCounts was = countScene(before);
    const SceneCounts is = countScene(after);
    if (way.compression == Compression::Draco) { // has no triangles with two equal corners
        EXPECT_LE(is.triangles, was.triangles);
    } else {
        EXPECT_EQ(is.triangles, was.triangles);
        if (way.instancing != Instancing::Expand) {
            EXPECT_EQ(is.unique_triangles, was.unique_triangles);
        }
    }
    if (way.instancing != Instancing::Expand) {
        EXPECT_EQ(is.instances, was.instances);
    }
    const Bounds old_bounds = worldBounds(before);
    const Bounds new_bounds = worldBounds(after);
    const double share = way.compression == Compression::None ? 1e-5 : 3e-4;
    const double tolerance = share * old_bounds.diagonal() + 1e-9;
    EXPECT_LE(glm::length(new_bounds.min - old_bounds.min), tolerance);
    EXPECT_LE(glm::length(new_bounds.max - old_bounds.max), tolerance);
}

void expectSameRest(const Scene& before, const Scene& after) {
    for (const char* list :
         {"materials", "textures", "samplers", "images", "cameras", "animations", "skins"})
        EXPECT_EQ(untouched(after, list), untouched(before, list)) << list;
    for (const char* key : {"extras", "extensions"}) // lights, variants and what nobody knows
        EXPECT_EQ(after.source->json.value(key, json()), before.source->json.value(key, json()))
            << key;
    ASSERT_EQ(after.images.size(), before.images.size());
    for (std::size_t i = 0; i < before.images.size(); ++i) {
        ASSERT_EQ(after.images[i].bytes != nullptr, before.images[i].bytes != nullptr);
        EXPECT_TRUE(!before.images[i].bytes || !after.images[i].bytes ||
                    *after.images[i].bytes == *before.images[i].bytes)
            << "image " << i;
    }
}

void expectSameAttributes(const std::vector<Attribute>& before,
                          const std::vector<Attribute>& after) {
    EXPECT_EQ(after.size(), before.size());
    for (const Attribute& was : before) {
        const Attribute* is = findAttribute(after, was.semantic);
        ASSERT_NE(is, nullptr) << was.semantic;
        EXPECT_EQ(is->type, was.type) << was.semantic;
        EXPECT_EQ(is->components, was.components) << was.semantic;
        EXPECT_EQ(is->normalized, was.normalized) << was.semantic;
        EXPECT_TRUE(is->bytes == was.bytes) << was.semantic;
    }
}

// Every vertex, index and attribute to the bit.
void expectSameGeometry(const Scene& before, const Scene& after) {
    ASSERT_EQ(after.submeshes.size(), before.submeshes.size());
    for (std::size_t s = 0; s < before.submeshes.size(); ++s) {
        SCOPED_TRACE("submesh " + std::to_string(s));
        const std::vector<Primitive>& was = before.submeshes[s].primitives;
        const std::vector<Primitive>& is = after.submeshes[s].primitives;
        EXPECT_EQ(after.submeshes[s].name, before.submeshes[s].name);
        ASSERT_EQ(is.size(), was.size());
        for (std::size_t p = 0; p < was.size(); ++p) {
            const Geometry& old_geometry = *was[p].geometry;
            const Geometry& new_geometry = *is[p].geometry;
            EXPECT_EQ(is[p].mode, was[p].mode);
            EXPECT_EQ(is[p].material, was[p].material);
            EXPECT_TRUE(new_geometry.positions == old_geometry.positions);
            EXPECT_TRUE(new_geometry.indices == old_geometry.indices);
            expectSameAttributes(old_geometry.attributes, new_geometry.attributes);
            ASSERT_EQ(new_geometry.morph_targets.size(), old_geometry.morph_targets.size());
            for (std::size_t t = 0; t < old_geometry.morph_targets.size(); ++t)
                expectSameAttributes(old_geometry.morph_targets[t].attributes,
                                     new_geometry.morph_targets[t].attributes);
        }
    }
}

// One node of the file stands for many.
bool hasRows(const Scene& scene) {
    return std::ranges::any_of(
        scene.instances, [](const Instance& instance) { return instance.gpu_index != kNone; });
}

// Names and what hangs on nodes beside meshes: extras, cameras, lights, unknown extensions.
std::vector<json> nodesWithMore(const Scene& scene) {
    std::vector<json> nodes;
    for (json node : scene.source->json.value("nodes", json::array())) {
        for (const char* key : {"children", "mesh", "skin", "matrix", "translation"})
            node.erase(key);
        for (const char* key : {"rotation", "scale", "weights"})
            node.erase(key);
        if (node.contains("extensions")) {
            node["extensions"].erase("EXT_mesh_gpu_instancing");
            if (node["extensions"].empty())
                node.erase("extensions");
        }
        nodes.push_back(std::move(node));
    }
    std::ranges::sort(nodes);
    return nodes;
}

TEST_P(ModelsExport, ComesBackAsPredictedAndWithEverythingItHad) {
    const auto scene = importScene(modelsFolder() / GetParam(), {});
    if (!scene)
        GTEST_SKIP() << scene.error().message;
    for (const Way& way : kWays) {
        SCOPED_TRACE(way.name + std::string(way.extension));
        const ScenePtr again = sent(*scene, way);
        if (!again)
            continue;
        expectSameShape(**scene, *again, way);
        expectSameRest(**scene, *again);
        if (way.instancing != Instancing::Expand && way.compression == Compression::None)
            expectSameGeometry(**scene, *again);
        if (way.instancing == Instancing::Nodes && !hasRows(**scene)) {
            EXPECT_TRUE(nodesWithMore(*again) == nodesWithMore(**scene));
        }
    }
}

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(ModelsExport);
INSTANTIATE_TEST_SUITE_P(Models,
                         ModelsExport,
                         ::testing::ValuesIn(relativeModelFiles()),
                         [](const auto& file) { return wordFor(file.param); });

// Without models there is nothing to sweep; with CI=true that is a failure.
class ModelsExportFolder : public tests::ModelsTest {};

TEST_F(ModelsExportFolder, HasModelsOfEveryFormat) {
    EXPECT_GT(tests::modelFiles().size(), 60U);
}

} // namespace
} // namespace lodestone
