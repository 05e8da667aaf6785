#include "scene/gltf/material_reader.h"

#include <cmath>
#include <tiny_gltf.h>

namespace lodestone {

using nlohmann::json;

namespace {

// The part of the document that describes surfaces, typed and with defaults filled in by tinygltf.
// Geometry and files are not given to it: it follows paths out of the folder and does not hold
// accessors against the bytes that are there.
Result<tinygltf::Model> parseSurfaces(const ReadContext& context) {
    json part{{"asset", {{"version", "2.0"}}}};
    for (const char* name : {"materials", "textures", "samplers"})
        if (const json* list = member(context.document.json, name))
            part[name] = *list;
    tinygltf::Model model;
    tinygltf::TinyGLTF loader;
    std::string error;
    std::string warning;
    try {
        const std::string text = part.dump(-1, ' ', false, json::error_handler_t::replace);
        if (!loader.LoadASCIIFromString(&model,
                                        &error,
                                        &warning,
                                        text.data(),
                                        static_cast<unsigned int>(text.size()),
                                        "",
                                        tinygltf::NO_REQUIRE))
            return context.bad("materials are invalid (" + error.substr(0, error.find('\n')) +
                               "): re-export the file");
    } catch (const std::exception& e) {
        return context.bad("materials are invalid (" + std::string(e.what()).substr(0, 120) +
                           "): re-export the file");
    }
    return model;
}

TextureWrap wrapOf(int code) {
    switch (code) {
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
        return TextureWrap::ClampToEdge;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
        return TextureWrap::MirroredRepeat;
    default:
        return TextureWrap::Repeat;
    }
}

float pairValue(const json& transform, std::string_view key, std::size_t i, float otherwise) {
    const json* pair = member(transform, key);
    if (pair == nullptr || !pair->is_array() || pair->size() != 2 || !(*pair)[i].is_number())
        return otherwise;
    return (*pair)[i].get<float>();
}

// translation * rotation * scale; v points down, so a turn to the left has its sine negated.
glm::mat3 uvTransform(const json& transform) {
    const double angle = numberMember(transform, "rotation", 0.0);
    const auto c = static_cast<float>(std::cos(angle));
    const auto s = static_cast<float>(std::sin(angle));
    const float scale_u = pairValue(transform, "scale", 0, 1.0f);
    const float scale_v = pairValue(transform, "scale", 1, 1.0f);
    return {c * scale_u,
            -s * scale_u,
            0.0f,
            s * scale_v,
            c * scale_v,
            0.0f,
            pairValue(transform, "offset", 0, 0.0f),
            pairValue(transform, "offset", 1, 0.0f),
            1.0f};
}

class MaterialReader {
public:
    MaterialReader(const tinygltf::Model& model, const json& document)
        : model_(model), textures_(listOf(document, "textures")),
          image_count_(listOf(document, "images").size()) {}

    Material read(const tinygltf::Material& from, const json& words) const {
        static const json empty = json::object();
        const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
        const json* pbr_words = member(words, "pbrMetallicRoughness");
        const json& pbr_source = pbr_words == nullptr ? empty : *pbr_words;
        Material to;
        to.name = from.name;
        for (int i = 0; i < 4; ++i)
            to.base_color[i] = static_cast<float>(pbr.baseColorFactor[static_cast<std::size_t>(i)]);
        to.metallic = static_cast<float>(pbr.metallicFactor);
        to.roughness = static_cast<float>(pbr.roughnessFactor);
        to.base_color_texture = texture(pbr.baseColorTexture, pbr_source, "baseColorTexture");
        to.metallic_roughness_texture =
            texture(pbr.metallicRoughnessTexture, pbr_source, "metallicRoughnessTexture");
        to.normal_texture = texture(from.normalTexture, words, "normalTexture");
        to.normal_scale = static_cast<float>(from.normalTexture.scale);
        to.occlusion_texture = texture(from.occlusionTexture, words, "occlusionTexture");
        to.occlusion_strength = static_cast<float>(from.occlusionTexture.strength);
        to.emissive_texture = texture(from.emissiveTexture, words, "emissiveTexture");
        for (std::size_t i = 0; i < 3 && i < from.emissiveFactor.size(); ++i)
            to.emissive[static_cast<int>(i)] = static_cast<float>(from.emissiveFactor[i]);
        if (const json* strength = extension(words, "KHR_materials_emissive_strength"))
            to.emissive *= static_cast<float>(numberMember(*strength, "emissiveStrength", 1.0));
        to.alpha_mode = from.alphaMode == "MASK"    ? AlphaMode::Mask
                        : from.alphaMode == "BLEND" ? AlphaMode::Blend
                                                    : AlphaMode::Opaque;
        to.alpha_cutoff = static_cast<float>(from.alphaCutoff);
        to.double_sided = from.doubleSided;
        to.unlit = extension(words, "KHR_materials_unlit") != nullptr;
        return to;
    }

private:
    std::uint32_t imageOf(std::size_t texture_index) const {
        const int source = model_.textures[texture_index].source;
        if (source >= 0)
            return static_cast<std::uint32_t>(source);
        for (const char* name : {"KHR_texture_basisu", "EXT_texture_webp"})
            if (const json* words = extension(textures_[texture_index], name))
                if (const auto image = unsignedMember(*words, "source");
                    image && *image < image_count_)
                    return static_cast<std::uint32_t>(*image);
        return kNone;
    }

    template <class Info>
    TextureRef texture(const Info& info, const json& parent, std::string_view key) const {
        TextureRef to;
        if (info.index < 0)
            return to;
        const auto index = static_cast<std::size_t>(info.index);
        to.image = imageOf(index);
        to.texcoord = static_cast<std::uint32_t>(info.texCoord);
        if (const int sampler = model_.textures[index].sampler; sampler >= 0) {
            const tinygltf::Sampler& from = model_.samplers[static_cast<std::size_t>(sampler)];
            to.wrap_u = wrapOf(from.wrapS);
            to.wrap_v = wrapOf(from.wrapT);
            to.nearest = from.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
        }
        const json* words = member(parent, key);
        if (words == nullptr)
            return to;
        if (const json* transform = extension(*words, "KHR_texture_transform")) {
            to.uv_transform = uvTransform(*transform);
            if (const auto texcoord = unsignedMember(*transform, "texCoord"))
                to.texcoord = static_cast<std::uint32_t>(*texcoord);
        }
        return to;
    }

    const tinygltf::Model& model_;
    const json& textures_;
    std::size_t image_count_;
};

} // namespace

Result<void> readMaterials(const ReadContext& context) {
    const json& materials = listOf(context.document.json, "materials");
    if (materials.empty())
        return {};
    const Result<tinygltf::Model> model = parseSurfaces(context);
    if (!model)
        return tl::make_unexpected(model.error());
    const MaterialReader reader(*model, context.document.json);
    for (std::size_t m = 0; m < materials.size(); ++m)
        context.scene.materials.push_back(reader.read(model->materials[m], materials[m]));
    return {};
}

} // namespace lodestone
