#pragma once
// The scene every room shares. Built once by an importer or a generator, then immutable and passed
// as shared_ptr<const Scene>. No GL, no window, no globals.
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace lodestone {

constexpr std::uint32_t kNone = 0xFFFFFFFFu; // "no such object" for every index below

// glTF component types, same numbers.
enum class ComponentType : std::uint16_t {
    Int8 = 5120,
    UInt8 = 5121,
    Int16 = 5122,
    UInt16 = 5123,
    UInt32 = 5125,
    Float32 = 5126,
};

std::size_t byteSize(ComponentType type); // of one component

// A vertex attribute other than POSITION as the file stores it, tightly packed (no stride).
struct Attribute {
    std::string semantic; // glTF name: NORMAL, TANGENT, TEXCOORD_0, COLOR_0, JOINTS_0, _CUSTOM
    ComponentType type = ComponentType::Float32;
    std::uint8_t components = 3; // 1..4 (or 9, 16 for matrices)
    bool normalized = false;
    std::vector<std::byte> bytes; // [vertex_count * components * byteSize(type)]

    std::size_t stride() const { return components * byteSize(type); }
};

// Component value as float, normalised integers decoded by glTF's rule. vertex, component in range.
float attributeValue(const Attribute& attribute, std::size_t vertex, std::size_t component);
// Inverse: rounds and clamps to what the type can hold.
void setAttributeValue(Attribute& attribute,
                       std::size_t vertex,
                       std::size_t component,
                       float value);
// First attribute of that name, or nullptr.
const Attribute* findAttribute(std::span<const Attribute> attributes, std::string_view semantic);

struct MorphTarget {
    std::vector<Attribute> attributes; // deltas, POSITION among them; same vertex count
};

// Vertices and indices of one primitive. Shared between scene, LODs, renderer and exporter; the
// pointer is the identity (same pointer = same content, nothing to upload or compare).
struct Geometry {
    std::vector<glm::vec3> positions; // finite
    std::vector<Attribute> attributes;
    std::vector<MorphTarget> morph_targets;
    std::vector<std::uint32_t> indices; // < positions.size(); [3 * triangles] for triangle lists
    // First vertex of each block that is not welded with the others (an expanded scene has one
    // block an instance); rising. Empty: one block.
    std::vector<std::uint32_t> weld_blocks;

    std::size_t triangleCount() const { return indices.size() / 3; }
};

using GeometryPtr = std::shared_ptr<const Geometry>;

// Strips and fans become Triangles at import. Everything else is kept untouched and drawn.
enum class PrimitiveMode : std::uint8_t {
    Points = 0,
    Lines = 1,
    LineLoop = 2,
    LineStrip = 3,
    Triangles = 4,
};

struct Primitive {
    PrimitiveMode mode = PrimitiveMode::Triangles;
    GeometryPtr geometry; // never null
    std::uint32_t material = kNone;
    // How the file stores POSITION (KHR_mesh_quantization); an export rounds to the same grid.
    ComponentType position_type = ComponentType::Float32;
    bool position_normalized = false;
};

// A mesh that instances refer to: what a glTF mesh, a COLLADA geometry is.
struct Submesh {
    std::string name;
    std::vector<Primitive> primitives;
};

struct Instance {
    glm::dmat4 transform{1.0}; // product of all transforms from the root
    std::uint32_t submesh = 0;
    std::uint32_t node = kNone;      // in Scene::nodes
    std::uint32_t gpu_index = kNone; // row of the node's EXT_mesh_gpu_instancing, else kNone
};

struct Node {
    std::string name;
    std::uint32_t parent = kNone;
    std::uint32_t submesh = kNone;
    std::uint32_t camera = kNone;
    std::uint32_t skin = kNone;
    bool animated = false; // a channel targets it or one of its ancestors
    bool foldable = false; // leaf without animation, skin, extras or unknown extensions
    glm::dmat4 world{1.0};
};

enum class AlphaMode : std::uint8_t { Opaque, Mask, Blend };
enum class TextureWrap : std::uint8_t { Repeat, ClampToEdge, MirroredRepeat };

struct TextureRef {
    std::uint32_t image = kNone;
    std::uint32_t texcoord = 0; // TEXCOORD_n
    TextureWrap wrap_u = TextureWrap::Repeat;
    TextureWrap wrap_v = TextureWrap::Repeat;
    bool nearest = false;         // magnification filter
    glm::mat3 uv_transform{1.0f}; // KHR_texture_transform
};

// What drawing needs of a material. The file's own words survive in Scene::source.
struct Material {
    std::string name;
    glm::vec4 base_color{1.0f}; // linear
    TextureRef base_color_texture;
    float metallic = 1.0f;
    float roughness = 1.0f;
    TextureRef metallic_roughness_texture;
    TextureRef normal_texture;
    float normal_scale = 1.0f;
    TextureRef occlusion_texture;
    float occlusion_strength = 1.0f;
    glm::vec3 emissive{0.0f};
    TextureRef emissive_texture;
    AlphaMode alpha_mode = AlphaMode::Opaque;
    float alpha_cutoff = 0.5f;
    bool double_sided = false;
    bool unlit = false;
};

// Encoded bytes as found (PNG, JPEG, KTX2, WebP); never decoded or re-encoded here.
struct Image {
    std::string name;
    std::string mime_type; // "image/png", ... ; empty if unknown
    std::string uri;       // as written in the file; empty if embedded
    std::shared_ptr<const std::vector<std::byte>> bytes; // null if the file is missing (noted)
};

struct Camera {
    std::string name;
    glm::dmat4 world{1.0}; // looks along -z
    bool perspective = true;
    double yfov_rad = 0.8;
    double znear = 0.1;
    double zfar = 0.0; // 0: infinite
    double xmag = 1.0; // orthographic half extents
    double ymag = 1.0;
};

struct SourceDocument; // scene/gltf/: the file's JSON and buffers; the untouched rest

struct Scene {
    std::string name; // file name without folder, or the sample's name
    std::vector<Submesh> submeshes;
    std::vector<Instance> instances; // sorted by submesh, then by order in the file
    std::vector<Node> nodes;
    std::vector<Material> materials;
    std::vector<Image> images;
    std::vector<Camera> cameras;
    std::shared_ptr<const SourceDocument> source; // never null: generators and assimp make one
    std::uint64_t file_bytes = 0; // of the file and all files it refers to; 0 for generated scenes
    std::vector<std::string> notes; // what the user should know (outliers, dropped parts)
};

using ScenePtr = std::shared_ptr<const Scene>;

// Half-open range of Scene::instances that draw a submesh.
struct InstanceRange {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;

    std::uint32_t size() const { return end - begin; }
};

std::vector<InstanceRange> instanceRanges(const Scene& scene); // [submeshes]

// Submeshes that no instance draws (kept for the export) do not count.
struct SceneCounts {
    std::uint64_t submeshes = 0;
    std::uint64_t instances = 0;
    std::uint64_t triangles = 0; // every instance counted
    std::uint64_t unique_triangles = 0;
    std::uint64_t vertices = 0; // unique, as stored
};

SceneCounts countScene(const Scene& scene);
std::uint64_t triangleCount(const Submesh& submesh); // once, not times its instances

struct Bounds {
    glm::dvec3 min{0.0};
    glm::dvec3 max{0.0};
    bool empty = true;

    void add(const glm::dvec3& point);

    glm::dvec3 center() const { return (min + max) * 0.5; }

    glm::dvec3 size() const { return max - min; }

    double diagonal() const;
};

Bounds localBounds(const Submesh& submesh);
// World bounds of all instances. O(vertices + instances * 8) (corner boxes) is not tight enough for
// the diagonal that errors are quoted in, so every instanced vertex is transformed; parallel.
Bounds worldBounds(const Scene& scene);
// The same without finite far outliers (vertices more than 1e6 times as far out as the bulk), for
// framing, thresholds and error percentages. Equals worldBounds where there are none.
Bounds robustWorldBounds(const Scene& scene);

} // namespace lodestone
