#include "scene/assimp/material_convert.h"

#include "scene/assimp/folder_io.h"

#include <algorithm>
#include <array>
#include <assimp/material.h>
#include <assimp/scene.h>
#include <cmath>
#include <fstream>

namespace lodestone {

namespace {

// Colours of these formats are meant for the screen; glTF's factors are linear.
float linear(float srgb) {
    if (!std::isfinite(srgb))
        return 0.0f;
    const float value = std::clamp(srgb, 0.0f, 1.0f);
    return value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
}

glm::vec3 linear(const aiColor3D& color) {
    return {linear(color.r), linear(color.g), linear(color.b)};
}

// Of a material without words of its own (PLY, STL, bare OBJ): a light grey that shading shows on.
constexpr float kPlainGrey = 0.6f;

std::string mimeTypeOf(std::span<const std::byte> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()),
                                std::min<std::size_t>(bytes.size(), 16));
    if (text.starts_with("\x89PNG"))
        return "image/png";
    if (text.starts_with("\xFF\xD8\xFF"))
        return "image/jpeg";
    if (text.starts_with("\xABKTX 20"))
        return "image/ktx2";
    if (text.starts_with("RIFF") && text.substr(8).starts_with("WEBP"))
        return "image/webp";
    if (text.starts_with("BM"))
        return "image/bmp";
    if (text.starts_with("GIF8"))
        return "image/gif";
    return "";
}

TextureWrap wrapOf(int mode) {
    switch (mode) {
    case aiTextureMapMode_Clamp:
    case aiTextureMapMode_Decal:
        return TextureWrap::ClampToEdge;
    case aiTextureMapMode_Mirror:
        return TextureWrap::MirroredRepeat;
    default:
        return TextureWrap::Repeat;
    }
}

// Shininess (a Phong exponent) as glTF's roughness: alpha = sqrt(2 / (n + 2)) = roughness^2.
float roughnessOf(float shininess) {
    return std::clamp(std::pow(2.0f / (std::max(shininess, 0.0f) + 2.0f), 0.25f), 0.0f, 1.0f);
}

// Those that convert() fills.
constexpr std::array kTextures{
    &Material::base_color_texture, &Material::normal_texture, &Material::emissive_texture};

std::uint32_t setsNeeded(const Material& material) {
    std::uint32_t sets = 0;
    for (const auto texture : kTextures)
        if ((material.*texture).image != kNone)
            sets = std::max(sets, (material.*texture).texcoord + 1);
    return sets;
}

// A texture without coordinates says nothing, and glTF forbids it.
Material limitedTo(std::uint32_t texcoord_sets, Material material) {
    for (const auto texture : kTextures) {
        if (texcoord_sets == 0)
            material.*texture = {};
        else
            (material.*texture).texcoord =
                std::min((material.*texture).texcoord, texcoord_sets - 1);
    }
    return material;
}

} // namespace

MaterialConverter::MaterialConverter(const aiScene& scene,
                                     const std::filesystem::path& folder,
                                     SceneBuilder& builder)
    : scene_(scene), folder_(folder), builder_(builder) {}

std::uint32_t MaterialConverter::material(std::uint32_t index, std::uint32_t texcoord_sets) {
    if (index >= scene_.mNumMaterials)
        return kNone;
    auto found = converted_.find(index);
    if (found == converted_.end())
        found = converted_.emplace(index, convert(*scene_.mMaterials[index])).first;
    const std::uint32_t sets = std::min(texcoord_sets, setsNeeded(found->second));
    const auto known = materials_.find({index, sets});
    if (known != materials_.end())
        return known->second;
    const std::uint32_t added = builder_.addMaterial(limitedTo(sets, found->second));
    materials_.emplace(std::pair(index, sets), added);
    return added;
}

Material MaterialConverter::convert(const aiMaterial& from) {
    Material to;
    aiString name;
    if (from.Get(AI_MATKEY_NAME, name) == aiReturn_SUCCESS)
        to.name = name.C_Str();
    to.metallic = 0.0f;
    to.double_sided = true; // these formats draw both sides, and many files rely on it
    to.base_color_texture = texture(from, aiTextureType_BASE_COLOR);
    if (to.base_color_texture.image == kNone)
        to.base_color_texture = texture(from, aiTextureType_DIFFUSE);
    to.normal_texture = texture(from, aiTextureType_NORMALS);
    to.emissive_texture = texture(from, aiTextureType_EMISSIVE);

    aiColor3D color;
    const bool plain = to.name == AI_DEFAULT_MATERIAL_NAME;
    if (plain)
        to.base_color = glm::vec4(glm::vec3(linear(kPlainGrey)), 1.0f);
    else if (to.base_color_texture.image == kNone &&
             from.Get(AI_MATKEY_COLOR_DIFFUSE, color) == aiReturn_SUCCESS)
        to.base_color = glm::vec4(linear(color), 1.0f);
    if (to.emissive_texture.image != kNone)
        to.emissive = glm::vec3(1.0f);
    else if (from.Get(AI_MATKEY_COLOR_EMISSIVE, color) == aiReturn_SUCCESS)
        to.emissive = linear(color);

    float value = 0.0f;
    if (from.Get(AI_MATKEY_ROUGHNESS_FACTOR, value) == aiReturn_SUCCESS && std::isfinite(value))
        to.roughness = std::clamp(value, 0.0f, 1.0f);
    else if (from.Get(AI_MATKEY_SHININESS, value) == aiReturn_SUCCESS && std::isfinite(value))
        to.roughness = roughnessOf(value);
    if (from.Get(AI_MATKEY_METALLIC_FACTOR, value) == aiReturn_SUCCESS && std::isfinite(value))
        to.metallic = std::clamp(value, 0.0f, 1.0f);
    // Opacity 0 is how careless exporters write "not set".
    if (from.Get(AI_MATKEY_OPACITY, value) == aiReturn_SUCCESS && value > 0.0f && value < 1.0f) {
        to.base_color.a = value;
        to.alpha_mode = AlphaMode::Blend;
    }
    const TextureRef opacity = texture(from, aiTextureType_OPACITY);
    if (opacity.image != kNone && opacity.image == to.base_color_texture.image &&
        to.alpha_mode == AlphaMode::Opaque)
        to.alpha_mode = AlphaMode::Mask;
    return to;
}

TextureRef MaterialConverter::texture(const aiMaterial& from, unsigned type) {
    const auto texture_type = static_cast<aiTextureType>(type);
    TextureRef to;
    aiString reference;
    if (from.Get(AI_MATKEY_TEXTURE(texture_type, 0), reference) != aiReturn_SUCCESS ||
        reference.length == 0)
        return to;
    to.image = image(reference.C_Str());
    int value = 0;
    if (from.Get(AI_MATKEY_UVWSRC(texture_type, 0), value) == aiReturn_SUCCESS && value >= 0 &&
        value < AI_MAX_NUMBER_OF_TEXTURECOORDS)
        to.texcoord = static_cast<std::uint32_t>(value);
    if (from.Get(AI_MATKEY_MAPPINGMODE_U(texture_type, 0), value) == aiReturn_SUCCESS)
        to.wrap_u = wrapOf(value);
    if (from.Get(AI_MATKEY_MAPPINGMODE_V(texture_type, 0), value) == aiReturn_SUCCESS)
        to.wrap_v = wrapOf(value);
    return to;
}

std::uint32_t MaterialConverter::image(const std::string& reference) {
    const auto known = images_.find(reference);
    if (known != images_.end())
        return known->second;
    Image loaded = loadImage(reference);
    const std::uint32_t added = loaded.bytes ? builder_.addImage(std::move(loaded)) : kNone;
    images_.emplace(reference, added);
    return added;
}

// No bytes if it cannot be had; that is noted.
Image MaterialConverter::loadImage(const std::string& reference) {
    Image image;
    const auto take = [&](std::vector<std::byte> bytes) {
        image.mime_type = mimeTypeOf(bytes);
        image.bytes = std::make_shared<const std::vector<std::byte>>(std::move(bytes));
    };
    if (const aiTexture* embedded = scene_.GetEmbeddedTexture(reference.c_str())) {
        image.name = embedded->mFilename.C_Str();
        if (embedded->mHeight == 0) {
            const auto* data = reinterpret_cast<const std::byte*>(embedded->pcData);
            take({data, data + embedded->mWidth});
        } else {
            builder_.addNote("texture '" + reference + "' is embedded without encoding: left out");
        }
        return image;
    }
    const std::optional<std::filesystem::path> file = findBeside(folder_, reference);
    if (!file) {
        builder_.addNote("texture '" + reference +
                         "' is missing in the model's folder: drawn without");
        return image;
    }
    std::ifstream stream(*file, std::ios::binary);
    std::vector<char> data{std::istreambuf_iterator<char>(stream), {}};
    if (data.empty()) {
        builder_.addNote("texture '" + reference + "' is empty: drawn without");
        return image;
    }
    image.name = file->filename().string();
    image.uri = reference;
    image_file_bytes_ += data.size();
    const auto* begin = reinterpret_cast<const std::byte*>(data.data());
    take({begin, begin + data.size()});
    return image;
}

} // namespace lodestone
