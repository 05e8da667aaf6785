#include "scene/scene_builder.h"

#include "scene/gltf/quantization.h"
#include "scene/gltf/source_document.h"

#include <algorithm>
#include <cassert>

namespace lodestone {

using nlohmann::json;

glm::dmat4 toMatrix(const Trs& trs) {
    glm::dmat4 matrix = glm::mat4_cast(trs.rotation);
    for (int column = 0; column < 3; ++column)
        matrix[column] *= trs.scale[column];
    matrix[3] = glm::dvec4(trs.translation, 1.0);
    return matrix;
}

bool decompose(const glm::dmat4& matrix, Trs& out) {
    glm::dmat3 axes(matrix);
    Trs trs;
    trs.translation = glm::dvec3(matrix[3]);
    for (int column = 0; column < 3; ++column) {
        trs.scale[column] = glm::length(axes[column]);
        if (!(trs.scale[column] > 0.0))
            return false;
        axes[column] /= trs.scale[column];
    }
    if (glm::determinant(axes) < 0.0) {
        trs.scale.x = -trs.scale.x;
        axes[0] = -axes[0];
    }
    trs.rotation = glm::normalize(glm::quat_cast(axes));
    const double tolerance = 1e-6 * std::max({std::abs(trs.scale.x), trs.scale.y, trs.scale.z});
    const glm::dmat4 difference = toMatrix(trs) - matrix;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            if (!(std::abs(difference[column][row]) <= (row == 3 ? 1e-12 : tolerance)))
                return false;
    out = trs;
    return true;
}

namespace {

json toJson(const glm::dvec3& v) {
    return json::array({v.x, v.y, v.z});
}

void writeTrs(json& node, const Trs& trs) {
    if (trs.translation != glm::dvec3(0.0))
        node["translation"] = toJson(trs.translation);
    const glm::dquat& q = trs.rotation;
    if (q != glm::dquat(1.0, 0.0, 0.0, 0.0))
        node["rotation"] = json::array({q.x, q.y, q.z, q.w});
    if (trs.scale != glm::dvec3(1.0))
        node["scale"] = toJson(trs.scale);
}

void writeMatrix(json& node, const glm::dmat4& matrix) {
    json values = json::array();
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            values.push_back(matrix[column][row]);
    node["matrix"] = std::move(values);
}

int wrapCode(TextureWrap wrap) {
    switch (wrap) {
    case TextureWrap::ClampToEdge:
        return 33071;
    case TextureWrap::MirroredRepeat:
        return 33648;
    case TextureWrap::Repeat:
        break;
    }
    return 10497;
}

// Index of a value in a list of the document, put there if it is new.
std::size_t indexOf(json& list, const json& value) {
    const auto found = std::ranges::find(list, value);
    const auto index = static_cast<std::size_t>(found - list.begin());
    if (found == list.end())
        list.push_back(value);
    return index;
}

void useExtension(json& document, const std::string& name) {
    indexOf(document["extensionsUsed"], name);
}

// KHR_texture_transform of a matrix made of offset * rotation * scale.
json textureTransform(const glm::mat3& m) {
    const double scale_x = std::hypot(m[0][0], m[0][1]);
    const double scale_y = std::hypot(m[1][0], m[1][1]);
    return json{{"offset", {m[2][0], m[2][1]}},
                {"rotation", std::atan2(-m[0][1], m[0][0])},
                {"scale", {scale_x, scale_y}}};
}

json textureInfo(json& document, const TextureRef& texture) {
    json sampler{{"wrapS", wrapCode(texture.wrap_u)}, {"wrapT", wrapCode(texture.wrap_v)}};
    sampler["magFilter"] = texture.nearest ? 9728 : 9729;
    sampler["minFilter"] = texture.nearest ? 9984 : 9987;
    const std::size_t sampler_index = indexOf(document["samplers"], sampler);
    const json entry{{"sampler", sampler_index}, {"source", texture.image}};
    json info{{"index", indexOf(document["textures"], entry)}};
    if (texture.texcoord != 0)
        info["texCoord"] = texture.texcoord;
    if (texture.uv_transform != glm::mat3(1.0f)) {
        info["extensions"]["KHR_texture_transform"] = textureTransform(texture.uv_transform);
        useExtension(document, "KHR_texture_transform");
    }
    return info;
}

json pbrJson(json& document, const Material& material) {
    const glm::vec4& c = material.base_color;
    json pbr = json::object();
    if (c != glm::vec4(1.0f))
        pbr["baseColorFactor"] = {shortNumber(static_cast<double>(c.r)),
                                  shortNumber(static_cast<double>(c.g)),
                                  shortNumber(static_cast<double>(c.b)),
                                  shortNumber(static_cast<double>(c.a))};
    if (material.metallic != 1.0f)
        pbr["metallicFactor"] = shortNumber(static_cast<double>(material.metallic));
    if (material.roughness != 1.0f)
        pbr["roughnessFactor"] = shortNumber(static_cast<double>(material.roughness));
    if (material.base_color_texture.image != kNone)
        pbr["baseColorTexture"] = textureInfo(document, material.base_color_texture);
    if (material.metallic_roughness_texture.image != kNone)
        pbr["metallicRoughnessTexture"] =
            textureInfo(document, material.metallic_roughness_texture);
    return pbr;
}

json materialJson(json& document, const Material& material) {
    json entry = json::object();
    if (!material.name.empty())
        entry["name"] = material.name;
    if (json pbr = pbrJson(document, material); !pbr.empty())
        entry["pbrMetallicRoughness"] = std::move(pbr);
    if (material.normal_texture.image != kNone) {
        entry["normalTexture"] = textureInfo(document, material.normal_texture);
        if (material.normal_scale != 1.0f)
            entry["normalTexture"]["scale"] = material.normal_scale;
    }
    if (material.occlusion_texture.image != kNone) {
        entry["occlusionTexture"] = textureInfo(document, material.occlusion_texture);
        if (material.occlusion_strength != 1.0f)
            entry["occlusionTexture"]["strength"] = material.occlusion_strength;
    }
    if (material.emissive_texture.image != kNone)
        entry["emissiveTexture"] = textureInfo(document, material.emissive_texture);
    if (const glm::vec3& e = material.emissive; e != glm::vec3(0.0f))
        entry["emissiveFactor"] = {e.r, e.g, e.b};
    if (material.alpha_mode != AlphaMode::Opaque)
        entry["alphaMode"] = material.alpha_mode == AlphaMode::Mask ? "MASK" : "BLEND";
    if (material.alpha_mode == AlphaMode::Mask && material.alpha_cutoff != 0.5f)
        entry["alphaCutoff"] = material.alpha_cutoff;
    if (material.double_sided)
        entry["doubleSided"] = true;
    if (material.unlit) {
        entry["extensions"]["KHR_materials_unlit"] = json::object();
        useExtension(document, "KHR_materials_unlit");
    }
    return entry;
}

json meshJson(const Submesh& submesh) {
    json mesh{{"primitives", json::array()}};
    if (!submesh.name.empty())
        mesh["name"] = submesh.name;
    for (const Primitive& primitive : submesh.primitives) {
        json entry = json::object();
        if (primitive.material != kNone)
            entry["material"] = primitive.material;
        if (primitive.mode != PrimitiveMode::Triangles)
            entry["mode"] = static_cast<int>(primitive.mode);
        mesh["primitives"].push_back(std::move(entry));
    }
    return mesh;
}

json cameraJson(const Camera& camera) {
    json lens{{"znear", camera.znear}};
    if (camera.zfar > 0.0)
        lens["zfar"] = camera.zfar;
    if (camera.perspective) {
        lens["yfov"] = camera.yfov_rad;
    } else {
        lens["xmag"] = camera.xmag;
        lens["ymag"] = camera.ymag;
    }
    const std::string type = camera.perspective ? "perspective" : "orthographic";
    json entry{{"type", type}, {type, std::move(lens)}};
    if (!camera.name.empty())
        entry["name"] = camera.name;
    return entry;
}

template <class T>
std::uint32_t append(std::vector<T>& list, T&& value) {
    list.push_back(std::forward<T>(value));
    return static_cast<std::uint32_t>(list.size() - 1);
}

} // namespace

struct SceneBuilder::Impl {
    std::shared_ptr<Scene> scene = std::make_shared<Scene>();
    std::shared_ptr<SourceDocument> document = std::make_shared<SourceDocument>();
    std::vector<bool> kept; // [nodes] never folded

    std::uint32_t
    addNode(std::string name, std::uint32_t parent, const glm::dmat4& local, json entry) {
        assert(parent == kNone || parent < scene->nodes.size());
        const auto index = static_cast<std::uint32_t>(scene->nodes.size());
        Node node;
        node.parent = parent;
        node.world = parent == kNone ? local : scene->nodes[parent].world * local;
        if (!name.empty())
            entry["name"] = name;
        node.name = std::move(name);
        json& nodes = document->json["nodes"];
        if (parent == kNone)
            document->json["scenes"][0]["nodes"].push_back(index);
        else
            nodes[parent]["children"].push_back(index);
        nodes.push_back(std::move(entry));
        scene->nodes.push_back(std::move(node));
        kept.push_back(false);
        document->node_of_node.push_back(index);
        return index;
    }

    void setSubmesh(std::uint32_t node, std::uint32_t submesh) {
        if (submesh == kNone)
            return;
        assert(submesh < scene->submeshes.size());
        scene->nodes[node].submesh = submesh;
        document->json["nodes"][node]["mesh"] = submesh;
    }

    void fillInstances() {
        std::vector<Instance> instances;
        for (std::uint32_t n = 0; n < scene->nodes.size(); ++n) {
            const Node& node = scene->nodes[n];
            if (node.submesh != kNone && !scene->submeshes[node.submesh].primitives.empty())
                instances.push_back({node.world, node.submesh, n, kNone});
        }
        std::ranges::stable_sort(instances, {}, &Instance::submesh);
        scene->instances = std::move(instances);
    }

    void flagFoldable() {
        std::vector<bool> leaf(scene->nodes.size(), true);
        for (const Node& node : scene->nodes)
            if (node.parent != kNone)
                leaf[node.parent] = false;
        for (std::size_t n = 0; n < scene->nodes.size(); ++n) {
            Node& node = scene->nodes[n];
            node.foldable = leaf[n] && !kept[n] && node.submesh != kNone && node.camera == kNone &&
                            node.skin == kNone && !node.animated;
        }
    }
};

SceneBuilder::SceneBuilder(std::string name) : impl_(std::make_unique<Impl>()) {
    json& document = impl_->document->json;
    document["asset"] = {{"version", "2.0"}, {"generator", "Lodestone"}};
    document["scene"] = 0;
    document["scenes"] = json::array({json{{"name", name}}});
    impl_->scene->name = std::move(name);
}

SceneBuilder::~SceneBuilder() = default;

std::uint32_t SceneBuilder::addImage(Image image) {
    json entry = json::object();
    if (!image.name.empty())
        entry["name"] = image.name;
    if (!image.mime_type.empty())
        entry["mimeType"] = image.mime_type;
    image.uri.clear();
    impl_->document->json["images"].push_back(std::move(entry));
    return append(impl_->scene->images, std::move(image));
}

std::uint32_t SceneBuilder::addMaterial(Material material) {
    json& document = impl_->document->json;
    json entry = materialJson(document, material);
    document["materials"].push_back(std::move(entry));
    return append(impl_->scene->materials, std::move(material));
}

std::uint32_t SceneBuilder::addSubmesh(Submesh submesh) {
    impl_->document->json["meshes"].push_back(meshJson(submesh));
    const std::uint32_t index = append(impl_->scene->submeshes, std::move(submesh));
    impl_->document->mesh_of_submesh.push_back(index);
    return index;
}

std::uint32_t SceneBuilder::addNode(std::string name,
                                    std::uint32_t parent,
                                    const glm::dmat4& local,
                                    std::uint32_t submesh) {
    json entry = json::object();
    Trs trs;
    if (decompose(local, trs))
        writeTrs(entry, trs);
    else
        writeMatrix(entry, local);
    const std::uint32_t node = impl_->addNode(std::move(name), parent, local, std::move(entry));
    impl_->setSubmesh(node, submesh);
    return node;
}

std::uint32_t SceneBuilder::addNode(std::string name,
                                    std::uint32_t parent,
                                    const Trs& local,
                                    std::uint32_t submesh) {
    json entry = json::object();
    writeTrs(entry, local);
    const std::uint32_t node =
        impl_->addNode(std::move(name), parent, toMatrix(local), std::move(entry));
    impl_->setSubmesh(node, submesh);
    return node;
}

std::uint32_t SceneBuilder::addCamera(Camera camera, std::uint32_t node) {
    assert(node < impl_->scene->nodes.size());
    camera.world = impl_->scene->nodes[node].world;
    impl_->document->json["cameras"].push_back(cameraJson(camera));
    const std::uint32_t index = append(impl_->scene->cameras, std::move(camera));
    impl_->document->json["nodes"][node]["camera"] = index;
    impl_->scene->nodes[node].camera = index;
    return index;
}

void SceneBuilder::addNote(std::string note) {
    impl_->scene->notes.push_back(std::move(note));
}

void SceneBuilder::setFileBytes(std::uint64_t bytes) {
    impl_->scene->file_bytes = bytes;
}

void SceneBuilder::keepNode(std::uint32_t node) {
    impl_->kept[node] = true;
}

SourceDocument& SceneBuilder::document() {
    return *impl_->document;
}

Node& SceneBuilder::node(std::uint32_t index) {
    return impl_->scene->nodes[index];
}

ScenePtr SceneBuilder::finish() {
    impl_->fillInstances();
    impl_->flagFoldable();
    impl_->scene->source = std::move(impl_->document);
    return std::move(impl_->scene);
}

} // namespace lodestone
