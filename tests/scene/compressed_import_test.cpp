// Reading of EXT_meshopt_compression and KHR_draco_mesh_compression.
#include "scene/gltf/source_document.h"
#include "tests/scene/gltf_maker.h"

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>

using namespace lodestone;
using lodestone::tests::GltfMaker;
using lodestone::tests::TempFolder;
using nlohmann::json;

namespace {

constexpr const char* kMeshopt = "EXT_meshopt_compression";
constexpr const char* kDraco = "KHR_draco_mesh_compression";

struct Grid {
    std::vector<glm::vec3> positions;
    std::vector<std::uint32_t> indices;
};

// A bent sheet of side x side squares.
Grid grid(std::uint32_t side) {
    Grid sheet;
    const std::uint32_t row = side + 1;
    for (std::uint32_t v = 0; v < row * row; ++v) {
        const auto x = static_cast<float>(v % row);
        sheet.positions.emplace_back(x, static_cast<float>(v / row), 0.1f * x * x);
    }
    for (std::uint32_t q = 0; q < side * side; ++q) {
        const std::uint32_t v = q / side * row + q % side;
        sheet.indices.insert(sheet.indices.end(), {v, v + 1, v + row, v + 1, v + row + 1, v + row});
    }
    return sheet;
}

template <class T>
std::span<const unsigned char> bytesOf(const std::vector<T>& values) {
    return {reinterpret_cast<const unsigned char*>(values.data()), values.size() * sizeof(T)};
}

// A .gltf whose buffer 1 is a fallback for what buffer 0 holds compressed.
class MeshoptMaker {
public:
    json document{{"asset", {{"version", "2.0"}}},
                  {"scene", 0},
                  {"scenes", {{{"nodes", {0}}}}},
                  {"nodes", {{{"mesh", 0}}}},
                  {"extensionsUsed", {kMeshopt}},
                  {"extensionsRequired", {kMeshopt}}};

    explicit MeshoptMaker(const Grid& sheet) {
        std::vector<unsigned char> code(
            meshopt_encodeVertexBufferBound(sheet.positions.size(), sizeof(glm::vec3)));
        code.resize(meshopt_encodeVertexBuffer(code.data(),
                                               code.size(),
                                               sheet.positions.data(),
                                               sheet.positions.size(),
                                               sizeof(glm::vec3)));
        addView(code, "ATTRIBUTES", sheet.positions.size(), sizeof(glm::vec3));
        code.resize(meshopt_encodeIndexBufferBound(sheet.indices.size(), sheet.positions.size()));
        code.resize(meshopt_encodeIndexBuffer(
            code.data(), code.size(), sheet.indices.data(), sheet.indices.size()));
        addView(code, "TRIANGLES", sheet.indices.size(), 4);
        document["buffers"] = {
            {{"uri", "a.bin"}, {"byteLength", compressed_.size()}},
            {{"byteLength", fallback_bytes_}, {"extensions", {{kMeshopt, {{"fallback", true}}}}}}};
        document["accessors"] = {{{"bufferView", 0},
                                  {"componentType", 5126},
                                  {"count", sheet.positions.size()},
                                  {"type", "VEC3"}},
                                 {{"bufferView", 1},
                                  {"componentType", 5125},
                                  {"count", sheet.indices.size()},
                                  {"type", "SCALAR"}}};
        document["meshes"] = {
            {{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}}}}};
    }

    json& words(std::size_t view) { return document["bufferViews"][view]["extensions"][kMeshopt]; }

    std::string& compressed() { return compressed_; }

    Result<ScenePtr> import() const {
        const TempFolder folder;
        folder.write("a.bin", compressed_);
        return importScene(folder.write("a.gltf", document.dump()), {});
    }

private:
    void addView(const std::vector<unsigned char>& code,
                 const std::string& mode,
                 std::size_t count,
                 std::size_t stride) {
        const std::size_t length = count * stride;
        document["bufferViews"].push_back({{"buffer", 1},
                                           {"byteOffset", fallback_bytes_},
                                           {"byteLength", length},
                                           {"extensions",
                                            {{kMeshopt,
                                              {{"buffer", 0},
                                               {"byteOffset", compressed_.size()},
                                               {"byteLength", code.size()},
                                               {"byteStride", stride},
                                               {"mode", mode},
                                               {"count", count}}}}}});
        fallback_bytes_ += length;
        compressed_.append(code.begin(), code.end());
        compressed_.resize((compressed_.size() + 3) / 4 * 4);
    }

    std::string compressed_;
    std::size_t fallback_bytes_ = 0;
};

void expectRefused(const Result<ScenePtr>& scene, const std::string& words) {
    ASSERT_FALSE(scene);
    EXPECT_EQ(scene.error().kind, ErrorKind::BadInput);
    EXPECT_NE(scene.error().message.find(words), std::string::npos) << scene.error().message;
}

// A file whose triangle list of positions and texture coordinates is compressed by Draco.
GltfMaker dracoMaker(const Grid& sheet) {
    draco::TriangleSoupMeshBuilder builder;
    const std::size_t faces = sheet.indices.size() / 3;
    builder.Start(static_cast<int>(faces));
    const int position =
        builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    for (std::size_t f = 0; f < faces; ++f) {
        const std::uint32_t* corner = sheet.indices.data() + 3 * f;
        builder.SetAttributeValuesForFace(position,
                                          draco::FaceIndex(static_cast<std::uint32_t>(f)),
                                          &sheet.positions[corner[0]],
                                          &sheet.positions[corner[1]],
                                          &sheet.positions[corner[2]]);
    }
    const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
    draco::Encoder encoder;
    draco::EncoderBuffer code;
    if (!encoder.EncodeMeshToBuffer(*mesh, &code).ok())
        throw std::runtime_error("Draco does not encode");
    GltfMaker maker;
    const std::size_t view =
        maker.addView(std::vector<char>(code.data(), code.data() + code.size()));
    maker.json["accessors"] = {
        {{"componentType", 5126}, {"count", mesh->num_points()}, {"type", "VEC3"}},
        {{"componentType", 5125}, {"count", sheet.indices.size()}, {"type", "SCALAR"}}};
    json primitive{{"attributes", {{"POSITION", 0}}}, {"indices", 1}};
    primitive["extensions"][kDraco] = {{"bufferView", view}, {"attributes", {{"POSITION", 0}}}};
    maker.json["meshes"] = {{{"primitives", json::array({primitive})}}};
    maker.json["extensionsUsed"] = {kDraco};
    maker.json["extensionsRequired"] = {kDraco};
    maker.addNode({{"mesh", 0}});
    return maker;
}

// Corners of all triangles, in an order of their own.
std::vector<std::array<float, 3>> sortedCorners(const std::vector<glm::vec3>& positions,
                                                const std::vector<std::uint32_t>& indices) {
    std::vector<std::array<float, 3>> corners;
    for (const std::uint32_t i : indices)
        corners.push_back({positions[i].x, positions[i].y, positions[i].z});
    std::ranges::sort(corners);
    return corners;
}

} // namespace

TEST(CompressedImport, MeshoptViewsAreReadBitForBit) {
    const Grid sheet = grid(9);
    const Result<ScenePtr> scene = MeshoptMaker(sheet).import();
    ASSERT_TRUE(scene) << scene.error().message;
    const Geometry& geometry = *(*scene)->submeshes[0].primitives[0].geometry;
    EXPECT_EQ(geometry.positions, sheet.positions);
    EXPECT_EQ(geometry.triangleCount(), sheet.indices.size() / 3);
    EXPECT_EQ(sortedCorners(geometry.positions, geometry.indices),
              sortedCorners(sheet.positions, sheet.indices));
    EXPECT_TRUE((*scene)->notes.empty());
}

TEST(CompressedImport, DamagedMeshoptDataAreRefused) {
    MeshoptMaker maker(grid(9));
    maker.compressed()[0] = '\x7f';
    expectRefused(maker.import(), "buffer view 0: EXT_meshopt_compression: the data are damaged");
}

TEST(CompressedImport, MeshoptNumbersAreHeldAgainstTheBytes) {
    MeshoptMaker too_many(grid(3));
    too_many.words(0)["count"] = 4'000'000'000;
    expectRefused(too_many.import(), "do not fit the view");
    MeshoptMaker outside(grid(3));
    outside.words(1)["byteLength"] = 1'000'000;
    expectRefused(outside.import(), "it leaves its buffer");
    MeshoptMaker stride(grid(3));
    stride.words(0)["byteStride"] = 10;
    expectRefused(stride.import(), "do not go together");
    MeshoptMaker endless(grid(3));
    endless.document["buffers"][1]["byteLength"] = 1'000'000'000'000;
    expectRefused(endless.import(), "cannot come out of");
    MeshoptMaker itself(grid(3));
    itself.words(0)["buffer"] = 1;
    expectRefused(itself.import(), "does not hold compressed bytes");
}

TEST(CompressedImport, DracoPrimitivesAreRead) {
    const Grid sheet = grid(9);
    const Result<ScenePtr> scene = dracoMaker(sheet).import();
    ASSERT_TRUE(scene) << scene.error().message;
    const Geometry& geometry = *(*scene)->submeshes[0].primitives[0].geometry;
    EXPECT_EQ(sortedCorners(geometry.positions, geometry.indices),
              sortedCorners(sheet.positions, sheet.indices));
    EXPECT_FALSE((*scene)->source->json.contains("extensionsRequired"));
}

TEST(CompressedImport, DamagedDracoDataAreRefused) {
    GltfMaker cut = dracoMaker(grid(9));
    cut.json["bufferViews"][0]["byteLength"] = 20;
    expectRefused(cut.import(), "KHR_draco_mesh_compression: the data are damaged");
    GltfMaker attribute = dracoMaker(grid(9));
    attribute.json["meshes"][0]["primitives"][0]["extensions"][kDraco]["attributes"]["POSITION"] =
        7;
    expectRefused(attribute.import(), "attribute 7 is not among the data");
    GltfMaker components = dracoMaker(grid(9));
    components.json["accessors"][0]["type"] = "VEC2";
    expectRefused(components.import(), "has 3 components, its accessor 2");
}
