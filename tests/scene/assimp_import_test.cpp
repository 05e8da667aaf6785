#include "scene/assimp/assimp_import.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

namespace lodestone {

namespace {

namespace fs = std::filesystem;

// A folder of its own for each test.
class AssimpImport : public ::testing::Test {
protected:
    void SetUp() override {
        const std::string test = ::testing::UnitTest::GetInstance()->current_test_info()->name();
        folder_ = fs::temp_directory_path() / ("lodestone_assimp_" + test);
        fs::remove_all(folder_);
        fs::create_directories(folder_ / "model");
    }

    void TearDown() override { fs::remove_all(folder_); }

    fs::path write(const std::string& name, const std::string& bytes) const {
        const fs::path path = folder_ / "model" / name;
        std::ofstream(path, std::ios::binary) << bytes;
        return path;
    }

    ScenePtr import(const std::string& name, const std::string& bytes) const {
        const Result<ScenePtr> scene = importWithAssimp(write(name, bytes), {});
        EXPECT_TRUE(scene) << scene.error().message;
        return scene.value_or(nullptr);
    }

    // The message of the refusal.
    std::string refusal(const std::string& name, const std::string& bytes) const {
        const Result<ScenePtr> scene = importWithAssimp(write(name, bytes), {});
        if (scene) {
            ADD_FAILURE() << name << " was imported";
            return {};
        }
        EXPECT_EQ(scene.error().kind, ErrorKind::BadInput);
        EXPECT_TRUE(scene.error().message.starts_with(name + ": ")) << scene.error().message;
        EXPECT_EQ(scene.error().message.find('\n'), std::string::npos);
        return scene.error().message;
    }

    fs::path folder_;
};

std::string collada(const std::string& asset, const std::string& nodes) {
    return R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset>)" +
           asset + R"(</asset>
<library_geometries><geometry id="tri" name="tri"><mesh>
<source id="p"><float_array id="pa" count="12">0 0 0 1 0 0 1 1 0 0 1 0</float_array>
<technique_common><accessor source="#pa" count="4" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="2"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2 0 2 3</p></triangles>
</mesh></geometry></library_geometries>)" +
           nodes + R"(<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

std::string visualScene(const std::string& nodes) {
    return R"(<library_visual_scenes><visual_scene id="s">)" + nodes +
           "</visual_scene></library_visual_scenes>";
}

const std::string kDraw = R"(<instance_geometry url="#tri"/>)";

const std::string kPlyHeader = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                               "property float y\nproperty float z\n";

std::string binaryStl(std::uint32_t announced, std::uint32_t held) {
    std::string bytes(80, ' ');
    bytes.append(reinterpret_cast<const char*>(&announced), 4);
    for (std::uint32_t t = 0; t < held; ++t) {
        const auto x = static_cast<float>(t);
        const float values[12] = {0, 0, 1, x, 0, 0, x + 1, 0, 0, x, 1, 0};
        bytes.append(reinterpret_cast<const char*>(values), sizeof values);
        bytes.append(2, '\0');
    }
    return bytes;
}

bool hasNote(const Scene& scene, std::string_view part) {
    return std::ranges::any_of(
        scene.notes, [&](const std::string& note) { return note.find(part) != std::string::npos; });
}

} // namespace

TEST_F(AssimpImport, ColladaNestedNodeInstancesShareOneSubmesh) {
    const ScenePtr scene =
        import("nested.dae",
               collada("",
                       R"(<library_nodes><node id="pair"><node id="l">)" + kDraw +
                           R"(</node><node id="r"><translate>2 0 0</translate>)" + kDraw +
                           "</node></node></library_nodes>" +
                           visualScene(R"(<node id="a"><instance_node url="#pair"/></node>
                        <node id="b"><translate>0 5 0</translate><instance_node url="#pair"/></node>)")));
    ASSERT_TRUE(scene);
    ASSERT_EQ(scene->submeshes.size(), 1u);
    ASSERT_EQ(scene->instances.size(), 4u);
    EXPECT_EQ(countScene(*scene).unique_triangles, 2u);
    const Geometry& geometry = *scene->submeshes[0].primitives[0].geometry;
    EXPECT_EQ(geometry.positions.size(), 4u); // corners joined
    EXPECT_EQ(findAttribute(geometry.attributes, "NORMAL"), nullptr);
    const glm::dvec3 last(scene->instances[3].transform[3]);
    EXPECT_EQ(last, glm::dvec3(2, 5, 0));
}

TEST_F(AssimpImport, ColladaUnitAndUpAxisAreHonoured) {
    const ScenePtr scene = import(
        "axes.dae",
        collada(R"(<unit meter="0.01" name="centimeter"/><up_axis>Z_UP</up_axis>)",
                visualScene(R"(<node id="n"><translate>0 0 100</translate>)" + kDraw + "</node>")));
    ASSERT_TRUE(scene);
    const glm::dmat4& world = scene->instances.at(0).transform;
    EXPECT_NEAR(glm::length(glm::dvec3(world[3]) - glm::dvec3(0, 1, 0)), 0.0, 1e-6);
    EXPECT_NEAR(glm::length(glm::dvec3(world[0])), 0.01, 1e-9);
}

TEST_F(AssimpImport, ColladaThatContainsItselfIsRefused) {
    EXPECT_NE(refusal("loop.dae",
                      collada("",
                              R"(<library_nodes><node id="a"><instance_node url="#b"/></node>
                              <node id="b"><instance_node url="#a"/></node></library_nodes>)" +
                                  visualScene(R"(<node id="r"><instance_node url="#a"/></node>)")))
                  .find("itself"),
              std::string::npos);
}

TEST_F(AssimpImport, ColladaThatUnfoldsWithoutBoundIsRefused) {
    std::string library = "<library_nodes>";
    for (int level = 0; level < 30; ++level) {
        const std::string next = std::to_string(level + 1);
        library += "<node id=\"n" + std::to_string(level) + "\">";
        for (int copy = 0; copy < 2; ++copy)
            library += "<instance_node url=\"#n" + next + "\"/>";
        library += "</node>";
    }
    library += "<node id=\"n30\">" + kDraw + "</node></library_nodes>";
    EXPECT_NE(
        refusal(
            "bomb.dae",
            collada("", library + visualScene(R"(<node id="r"><instance_node url="#n0"/></node>)")))
            .find("unfolds"),
        std::string::npos);
}

TEST_F(AssimpImport, XmlEntitiesAndDeepNestingAreRefused) {
    EXPECT_NE(
        refusal("entity.dae", "<?xml version=\"1.0\"?><!DOCTYPE C [<!ENTITY a \"b\">]><COLLADA/>")
            .find("entities"),
        std::string::npos);
    std::string deep = "<COLLADA>";
    for (int level = 0; level < 30'000; ++level)
        deep += "<node>";
    EXPECT_NE(refusal("deep.dae", deep).find("nests"), std::string::npos);
}

TEST_F(AssimpImport, ObjMaterialsOfOneObjectBecomePrimitivesOfOneSubmesh) {
    write("two.mtl", "newmtl red\nKd 1 0 0\nnewmtl glass\nKd 0 0 1\nd 0.5\n");
    const ScenePtr scene =
        import("two.obj",
               "mtllib two.mtl\no box\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nusemtl red\n"
               "f 1 2 3\nusemtl glass\nf 1 3 4\n");
    ASSERT_TRUE(scene);
    ASSERT_EQ(scene->submeshes.size(), 1u);
    ASSERT_EQ(scene->submeshes[0].primitives.size(), 2u);
    const Material& red = scene->materials.at(scene->submeshes[0].primitives[0].material);
    const Material& glass = scene->materials.at(scene->submeshes[0].primitives[1].material);
    EXPECT_EQ(red.base_color, glm::vec4(1, 0, 0, 1));
    EXPECT_TRUE(red.double_sided);
    EXPECT_EQ(red.metallic, 0.0f);
    EXPECT_EQ(glass.alpha_mode, AlphaMode::Blend);
    EXPECT_FLOAT_EQ(glass.base_color.a, 0.5f);
}

TEST_F(AssimpImport, TexturesKeepTheirBytesAndMissingOnesAreNoted) {
    const std::string png = "\x89PNG not really";
    write("Skin.PNG", png);
    write("t.mtl", "newmtl a\nmap_Kd C:\\art\\skin.png\nnewmtl b\nmap_Kd gone.png\n");
    const ScenePtr scene =
        import("t.obj",
               "mtllib t.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\n"
               "vt 1 0.25\nvt 1 1\nusemtl a\nf 1/1 2/2 3/3\nusemtl b\nf 1/1 3/3 4/2\n");
    ASSERT_TRUE(scene);
    ASSERT_EQ(scene->images.size(), 1u);
    const Image& image = scene->images[0];
    ASSERT_TRUE(image.bytes);
    EXPECT_EQ(image.mime_type, "image/png");
    EXPECT_EQ(std::string(reinterpret_cast<const char*>(image.bytes->data()), image.bytes->size()),
              png);
    EXPECT_TRUE(hasNote(*scene, "gone.png"));
    const Geometry& geometry = *scene->submeshes[0].primitives[0].geometry;
    const Attribute* uv = findAttribute(geometry.attributes, "TEXCOORD_0");
    ASSERT_NE(uv, nullptr);
    EXPECT_FLOAT_EQ(attributeValue(*uv, 1, 1), 0.75f); // v from above
}

TEST_F(AssimpImport, FilesOutsideTheModelsFolderAreNotRead) {
    std::ofstream(folder_ / "secret.png") << "\x89PNG secret";
    std::ofstream(folder_ / "secret.mtl") << "newmtl s\nKd 1 0 0\n";
    fs::create_symlink(folder_ / "secret.png", folder_ / "model" / "link.png");
    write("in.mtl",
          "newmtl a\nmap_Kd ../secret.png\nnewmtl b\nmap_Kd link.png\nnewmtl c\nmap_Kd " +
              (folder_ / "secret.png").string() + "\n");
    const ScenePtr scene = import("out.obj",
                                  "mtllib ../secret.mtl\nmtllib in.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\n"
                                  "usemtl a\nf 1 2 3\nusemtl b\nf 1 3 2\nusemtl c\nf 2 1 3\n");
    ASSERT_TRUE(scene);
    EXPECT_TRUE(scene->images.empty());
    for (const Material& material : scene->materials)
        EXPECT_NE(material.name, "s");
}

TEST_F(AssimpImport, ConcavePolygonsKeepTheirArea) {
    // An arrowhead: a fan from its first corner would cover more than the polygon.
    const ScenePtr scene =
        import("arrow.obj", "v 0 1 0\nv -2 -1 0\nv 0 0 0\nv 2 -1 0\nf 1 2 3 4\n");
    ASSERT_TRUE(scene);
    const Geometry& geometry = *scene->submeshes[0].primitives[0].geometry;
    ASSERT_EQ(geometry.triangleCount(), 2u);
    double area = 0.0;
    for (std::size_t t = 0; t < 2; ++t) {
        const auto at = [&](std::size_t c) {
            return geometry.positions[geometry.indices[3 * t + c]];
        };
        area += 0.5 * glm::length(glm::cross(at(1) - at(0), at(2) - at(0)));
    }
    EXPECT_NEAR(area, 2.0, 1e-6);
}

TEST_F(AssimpImport, PlyColoursSurviveAsNormalisedBytes) {
    const ScenePtr scene =
        import("c.ply",
               kPlyHeader + "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                            "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                            "0 0 0 1 128 255\n1 0 0 7 77 177\n0 1 0 0 0 0\n3 0 1 2\n");
    ASSERT_TRUE(scene);
    const Geometry& geometry = *scene->submeshes[0].primitives[0].geometry;
    const Attribute* color = findAttribute(geometry.attributes, "COLOR_0");
    ASSERT_NE(color, nullptr);
    EXPECT_EQ(color->type, ComponentType::UInt8);
    EXPECT_TRUE(color->normalized);
    ASSERT_EQ(color->bytes.size(), 12u);
    EXPECT_EQ(std::to_integer<int>(color->bytes[1]), 128);
    EXPECT_EQ(std::to_integer<int>(color->bytes[4]), 7);
    EXPECT_EQ(std::to_integer<int>(color->bytes[7]), 255); // opaque
}

TEST_F(AssimpImport, PlyWithoutFacesStaysAPointCloud) {
    const ScenePtr scene = import("p.ply", kPlyHeader + "end_header\n0 0 0\n0 0 0\n0 1 0\n");
    ASSERT_TRUE(scene);
    const Primitive& primitive = scene->submeshes.at(0).primitives.at(0);
    EXPECT_EQ(primitive.mode, PrimitiveMode::Points);
    EXPECT_EQ(primitive.geometry->positions.size(), 3u); // equal points stay two
}

TEST_F(AssimpImport, PlyThatPromisesMoreThanItHoldsIsRefused) {
    const std::string faces =
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n";
    const std::string lie = "ply\nformat binary_little_endian 1.0\nelement vertex 4294967295\n"
                            "property float x\nend_header\n1234";
    EXPECT_NE(refusal("lie.ply", lie).find("4294967295"), std::string::npos);
    EXPECT_NE(refusal("index.ply", kPlyHeader + faces + vertices + "3 0 1 9\n").find("vertex 9"),
              std::string::npos);
    EXPECT_NE(refusal("short.ply", kPlyHeader + faces + vertices + "3 0 1").find("face"),
              std::string::npos);
    EXPECT_NE(refusal("list.ply", kPlyHeader + faces + vertices + "900 0 1 2\n").find("face"),
              std::string::npos);
    refusal("negative.ply", "ply\nformat ascii 1.0\nelement face -5\nend_header\n");
    refusal("endless.ply", kPlyHeader);
}

TEST_F(AssimpImport, StlCountBeyondTheFileIsRefused) {
    EXPECT_NE(refusal("huge.stl", binaryStl(0xFFFFFFFFu, 2)).find("4294967295"), std::string::npos);
    const ScenePtr scene = import("good.stl", binaryStl(2, 2));
    ASSERT_TRUE(scene);
    EXPECT_EQ(countScene(*scene).triangles, 2u);
    EXPECT_EQ(countScene(*scene).vertices, 5u); // one corner is shared
}

TEST_F(AssimpImport, PositionsThatAreNotFiniteNameTheMesh) {
    const std::string message =
        refusal("nan.stl",
                "solid part\nfacet normal 0 0 1\nouter loop\nvertex nan 0 0\nvertex 1 0 0\n"
                "vertex 0 1 0\nendloop\nendfacet\nendsolid part\n");
    EXPECT_NE(message.find("part"), std::string::npos) << message;
    EXPECT_NE(message.find("finite"), std::string::npos) << message;
}

TEST_F(AssimpImport, EmptyAndMissingFilesAreBadInput) {
    for (const char* extension : {"dae", "3ds", "obj", "ply", "stl", "fbx"})
        refusal(std::string("empty.") + extension, "");
    EXPECT_FALSE(importWithAssimp(folder_ / "absent.obj", {}));
    refusal("nothing.obj", "# only a comment, long enough to be read as a file\n");
}

} // namespace lodestone
