#include "scene/gltf/reader.h"
#include "tests/scene/gltf_maker.h"

#include <limits>
#include <random>

using namespace lodestone;
using lodestone::tests::GltfMaker;
using lodestone::tests::TempFolder;
using nlohmann::json;

namespace {

// A drawable triangle; tests break it.
GltfMaker triangle() {
    GltfMaker maker;
    maker.addNode({{"mesh", maker.addTriangle()}, {"name", "leaf"}});
    maker.json["meshes"][0]["name"] = "blade";
    return maker;
}

void expectBadInput(const Result<ScenePtr>& result, const std::string& part) {
    ASSERT_FALSE(result) << "imported, expected: " << part;
    EXPECT_EQ(result.error().kind, ErrorKind::BadInput);
    EXPECT_NE(result.error().message.find(part), std::string::npos) << result.error().message;
    EXPECT_EQ(result.error().message.find('\n'), std::string::npos) << result.error().message;
}

void expectBadInput(const GltfMaker& maker, const std::string& part) {
    expectBadInput(maker.import(), part);
}

Result<ScenePtr> importBytes(const std::string& name, const std::string& bytes) {
    const TempFolder folder;
    return importScene(folder.write(name, bytes), {});
}

// Without a file on the disk.
Result<ScenePtr> importFromMemory(const std::string& bytes) {
    std::vector<std::byte> copy(bytes.size());
    if (!bytes.empty())
        std::memcpy(copy.data(), bytes.data(), bytes.size());
    return readGltfBytes(copy, "memory.glb", {});
}

} // namespace

TEST(BadInput, TheUnbrokenTriangleImports) {
    EXPECT_TRUE(triangle().import());
}

TEST(BadInput, AnIndexBeyondTheVerticesNamesMeshAndPrimitive) {
    GltfMaker maker = triangle();
    const std::uint16_t index = 812;
    std::memcpy(maker.buffer.data() + 36, &index, sizeof index);
    expectBadInput(maker,
                   "made.glb: mesh 0 'blade' primitive 0: index 812 is out of range (3 vertices)");
}

TEST(BadInput, NonFinitePositionsNameTheVertex) {
    for (const float value :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        GltfMaker maker = triangle();
        std::memcpy(maker.buffer.data() + 16, &value, sizeof value);
        expectBadInput(maker, "mesh 0 'blade' primitive 0: position of vertex 1 is not finite");
    }
}

TEST(BadInput, NodesThatAreTheirOwnAncestorAreAnError) {
    GltfMaker maker = triangle();
    maker.json["nodes"][0]["children"] = {1};
    maker.json["nodes"].push_back({{"children", {0}}});
    expectBadInput(maker, "is its own ancestor");
}

TEST(BadInput, ADiamondOfNodesCannotExplode) {
    GltfMaker maker = triangle();
    maker.json["nodes"] = json::array();
    for (int level = 0; level < 40; ++level) // 2^40 paths
        maker.json["nodes"].push_back({{"children", {level + 1, level + 1}}});
    maker.json["nodes"].push_back({{"mesh", 0}});
    expectBadInput(maker, "unfold to more than");
}

TEST(BadInput, CountsAreHeldAgainstTheBytesThatAreThere) {
    for (const std::uint64_t count : {4ull, 2147483647ull, 18446744073709551615ull}) {
        GltfMaker maker = triangle();
        maker.json["accessors"][0]["count"] = count;
        expectBadInput(maker, "elements do not fit buffer view 0");
    }
    GltfMaker zeros = triangle();
    zeros.json["accessors"][0].erase("bufferView");
    zeros.json["accessors"][0]["count"] = 4'000'000'000u;
    expectBadInput(zeros, "4000000000 elements without a buffer view");
}

TEST(BadInput, OffsetsThatWrapAreCaught) {
    for (const char* key : {"byteOffset", "byteLength"}) {
        GltfMaker maker = triangle();
        maker.json["bufferViews"][0][key] = std::numeric_limits<std::uint64_t>::max() - 3;
        expectBadInput(maker, "leaves buffer 0");
    }
    GltfMaker maker = triangle();
    maker.json["accessors"][0]["byteOffset"] = std::numeric_limits<std::uint64_t>::max() - 3;
    expectBadInput(maker, "do not fit buffer view 0");
}

TEST(BadInput, SparseIndicesBeyondTheAccessorAreCaught) {
    GltfMaker maker = triangle();
    maker.json["accessors"][0]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", maker.addView<std::uint8_t>({3})}, {"componentType", 5121}}},
        {"values", {{"bufferView", maker.addView<float>({7, 8, 9})}}}};
    expectBadInput(maker, "index 3 is out of range (3 elements)");
}

TEST(BadInput, AttributesMustCoverThePositions) {
    GltfMaker maker = triangle();
    maker.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
        maker.addAccessor<float>({0, 0, 1, 0, 0, 1}, 5126, "VEC3");
    expectBadInput(maker, "NORMAL has 2 elements but there are 3 positions");
}

TEST(BadInput, IndicesOfTheDocumentAreCheckedByName) {
    GltfMaker maker = triangle();
    maker.json["nodes"][0]["mesh"] = 77;
    expectBadInput(maker, "nodes[0].mesh is 77, which is out of range (1 meshes)");
    maker = triangle();
    maker.json["meshes"][0]["primitives"][0]["material"] = 0;
    expectBadInput(maker, "meshes[0].primitives[0].material is 0");
    maker = triangle();
    maker.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 9;
    expectBadInput(maker, "meshes[0].primitives[0].attributes.POSITION is 9");
    maker = triangle();
    maker.json["scenes"][0]["nodes"] = {3};
    expectBadInput(maker, "scenes[0].nodes[0] is 3");
}

TEST(BadInput, WrongJsonTypesAreNamed) {
    const auto broken = [](const char* pointer, const json& value) {
        GltfMaker maker = triangle();
        maker.json[json::json_pointer(pointer)] = value;
        return maker;
    };
    expectBadInput(broken("/nodes", 3), "nodes is not a list");
    expectBadInput(broken("/nodes/0", "x"), "nodes[0] is not an object");
    expectBadInput(broken("/nodes/0/translation", {1, 2}),
                   "nodes[0].translation is not a list of 3");
    expectBadInput(broken("/nodes/0/mesh", -1), "nodes[0].mesh is not an index");
    expectBadInput(broken("/meshes/0/primitives", json::object()), "primitives is not a list");
    expectBadInput(broken("/accessors/0/count", "3"), "accessors[0].count is not a whole number");
    expectBadInput(broken("/nodes/0/extensions", 1), "nodes[0].extensions is not an object");
}

TEST(BadInput, NothingToDrawIsAnError) {
    GltfMaker maker = triangle();
    maker.json["nodes"][0].erase("mesh");
    expectBadInput(maker, "nothing to draw");
    maker = triangle();
    maker.json.erase("nodes");
    maker.json["scenes"][0].erase("nodes");
    expectBadInput(maker, "nothing to draw");
    maker = triangle();
    maker.json["meshes"][0]["primitives"][0]["attributes"] = json::object();
    expectBadInput(maker, "nothing to draw");
}

TEST(BadInput, TransformsMustStayFinite) {
    GltfMaker maker = triangle();
    maker.json["nodes"][0]["scale"] = {1e200, 1, 1};
    maker.json["nodes"][0]["children"] = {1};
    maker.json["nodes"].push_back({{"scale", {1e200, 1, 1}}, {"mesh", 0}, {"name", "far"}});
    expectBadInput(maker, "node 1 'far': its transform is not finite");
    maker = triangle();
    maker.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] =
        maker.addAccessor<float>({0, std::numeric_limits<float>::infinity(), 0}, 5126, "VEC3");
    expectBadInput(maker, "node 0 'leaf': transform of GPU instance 0 is not finite");
}

TEST(BadInput, EveryTruncationOfAGlbIsAnError) {
    const std::string whole = triangle().glb();
    for (std::size_t size = 0; size < whole.size(); ++size)
        EXPECT_FALSE(importFromMemory(whole.substr(0, size))) << size;
}

TEST(BadInput, LyingGlbLengthsAreCaught) {
    const std::string whole = triangle().glb();
    const auto patched = [&](std::size_t at, std::uint32_t value) {
        std::string bytes = whole;
        std::memcpy(bytes.data() + at, &value, sizeof value);
        return bytes;
    };
    expectBadInput(importBytes("a.glb", patched(8, 0xFFFFFFFFu)), "header says 4294967295 bytes");
    expectBadInput(importBytes("a.glb", patched(12, 0xFFFFFFF0u)), "chunk at byte 20 says");
    expectBadInput(importBytes("a.glb", patched(4, 1)), "GLB version 1 is not supported");
}

TEST(BadInput, WhatIsNotGltfIsToldSo) {
    expectBadInput(importBytes("a.gltf", ""), "file is empty");
    expectBadInput(importBytes("a.gltf", "v 0 0 0\n"), "neither JSON nor GLB");
    expectBadInput(importBytes("a.gltf", "{\"asset\": "), "does not parse");
    expectBadInput(importBytes("a.gltf", "{}"), "not a glTF 2.0 file");
    expectBadInput(importBytes("a.gltf", R"({"asset": {"version": "1.0"}})"), "glTF 1.0");
    expectBadInput(importBytes("a.xyz", "{}"), "unknown file type '.xyz'");
    const TempFolder folder;
    expectBadInput(importScene(folder.path(), {}), "is a folder");
    expectBadInput(importScene(folder.write("plain", "{}"), {}), "has no extension");
    expectBadInput(importScene("/nowhere/a.glb", {}), "no such file");
    expectBadInput(importBytes("a.gltf", std::string(100'000, '[')), "neither JSON nor GLB");
    expectBadInput(importBytes("a.gltf", "{\"extras\":" + std::string(100'000, '[')),
                   "nested deeper than 256");
}

TEST(BadInput, FilesOutsideTheFolderAreRefused) {
    const TempFolder folder;
    GltfMaker maker = triangle();
    folder.write("secret.bin", maker.buffer);
    std::filesystem::create_directories(folder.path() / "model");
    std::filesystem::create_symlink(folder.path() / "secret.bin", folder.path() / "model/link.bin");
    std::filesystem::create_directory_symlink(folder.path(), folder.path() / "model/up");
    const std::string absolute = (folder.path() / "secret.bin").string();
    for (const std::string& uri : {std::string("../secret.bin"),
                                   std::string("%2e%2e/secret.bin"),
                                   std::string("sub/../../secret.bin"),
                                   std::string("link.bin"),
                                   std::string("up/secret.bin"),
                                   absolute,
                                   "file://" + absolute}) {
        maker.json["buffers"] = {{{"byteLength", maker.buffer.size()}, {"uri", uri}}};
        expectBadInput(importScene(folder.write("model/a.gltf", maker.json.dump()), {}),
                       "model's folder");
    }
}

TEST(ImportableFiles, AreThoseOfKnownTypesInAllFoldersBelowInOrder) {
    const TempFolder folder;
    std::filesystem::create_directories(folder.path() / "below" / "trap.glb");
    const std::filesystem::path upper = folder.write("below/b.GLB", "");
    const std::filesystem::path object = folder.write("a.obj", "");
    folder.write("notes.txt", "");
    EXPECT_EQ(importableFiles(folder.path()), (std::vector{object, upper}));
    EXPECT_TRUE(importableFiles(folder.path() / "absent").empty());
}

TEST(BadInput, MissingAndShortBuffersAreNamed) {
    const TempFolder folder;
    GltfMaker maker = triangle();
    maker.json["buffers"] = {{{"byteLength", maker.buffer.size()}, {"uri", "a.bin"}}};
    const std::filesystem::path file = folder.write("a.gltf", maker.json.dump());
    expectBadInput(importScene(file, {}), "buffer 0: a.bin: no such file");
    folder.write("a.bin", maker.buffer.substr(1));
    expectBadInput(importScene(file, {}), "buffer 0: has 41 bytes, byteLength says 42");
    maker.json["buffers"][0].erase("uri");
    expectBadInput(importScene(folder.write("a.gltf", maker.json.dump()), {}),
                   "buffer 0: has neither a uri nor a GLB chunk");
}

TEST(BadInput, DamagedCompressedGeometryIsNamedWithItsExtension) {
    GltfMaker maker = triangle();
    maker.json["accessors"][0].erase("bufferView");
    maker.json["meshes"][0]["primitives"][0]["extensions"] = {
        {"KHR_draco_mesh_compression", {{"bufferView", 0}, {"attributes", {{"POSITION", 0}}}}}};
    expectBadInput(maker, "KHR_draco_mesh_compression: the data are damaged");
}

TEST(BadInput, AStopRequestCancels) {
    const TempFolder folder;
    std::stop_source source;
    source.request_stop();
    const Result<ScenePtr> result =
        importScene(folder.write("a.glb", triangle().glb()), {source.get_token(), {}});
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().kind, ErrorKind::Cancelled);
}

// Flips bytes of a file that has a bit of everything. Whatever comes out must be a scene that keeps
// the reader's promises or an error of one line.
TEST(BadInput, FlippedBytesNeverBreakTheReader) {
    GltfMaker maker = triangle();
    maker.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", maker.addAccessor<float>({1, 0, 0, 2, 0, 0}, 5126, "VEC3")},
        {"ROTATION", maker.addAccessor<float>({0, 0, 0, 1, 0, 0, 1, 0}, 5126, "VEC4")}};
    json& primitive = maker.json["meshes"][0]["primitives"][0];
    primitive["attributes"]["NORMAL"] =
        maker.addAccessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, 5126, "VEC3");
    primitive["targets"] = {{{"POSITION", 0}}};
    primitive["material"] = 0;
    maker.json["accessors"][0]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", maker.addView<std::uint8_t>({2})}, {"componentType", 5121}}},
        {"values", {{"bufferView", maker.addView<float>({7, 8, 9})}}}};
    maker.json["images"] = {{{"bufferView", 0}, {"mimeType", "image/png"}}};
    maker.json["textures"] = {{{"source", 0}}};
    maker.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    maker.addNode({{"mesh", maker.addMesh({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, {}, 5)}});
    const std::string whole = maker.glb();
    ASSERT_TRUE(importFromMemory(whole));

    std::mt19937 random(7);
    int imported = 0;
    for (int round = 0; round < 3000; ++round) {
        std::string bytes = whole;
        for (std::uint32_t flips = random() % 4 + 1; flips > 0; --flips)
            bytes[random() % bytes.size()] = static_cast<char>(random() % 256);
        const Result<ScenePtr> scene = importFromMemory(bytes);
        if (!scene) {
            EXPECT_FALSE(scene.error().message.empty());
            continue;
        }
        ++imported;
        for (const Submesh& submesh : (*scene)->submeshes)
            for (const Primitive& part : submesh.primitives)
                for (const std::uint32_t index : part.geometry->indices)
                    ASSERT_LT(index, part.geometry->positions.size());
        for (const Instance& instance : (*scene)->instances)
            ASSERT_LT(instance.submesh, (*scene)->submeshes.size());
    }
    EXPECT_GT(imported, 100);  // many flips hit a value or a name
    EXPECT_LT(imported, 2900); // and many break something
}
