#pragma once
#include "scene/scene_builder.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

struct aiMaterial;
struct aiScene;

namespace lodestone {

// Turns assimp's materials and textures into the builder's, each once.
class MaterialConverter {
public:
    MaterialConverter(const aiScene& scene,
                      const std::filesystem::path& folder,
                      SceneBuilder& builder);

    // The builder's index of an assimp material as a mesh with that many sets of texture
    // coordinates can use it: textures take the last set there is; without any they are left out.
    // Converted when first asked for.
    std::uint32_t material(std::uint32_t index, std::uint32_t texcoord_sets);

    std::uint64_t imageFileBytes() const { return image_file_bytes_; }

private:
    Material convert(const aiMaterial& from);
    TextureRef texture(const aiMaterial& from, unsigned type);
    std::uint32_t image(const std::string& reference);
    Image loadImage(const std::string& reference);

    const aiScene& scene_;
    std::filesystem::path folder_;
    SceneBuilder& builder_;
    std::map<std::uint32_t, Material> converted_; // by assimp's index
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> materials_; // and sets used
    std::map<std::string, std::uint32_t> images_;
    std::uint64_t image_file_bytes_ = 0;
};

} // namespace lodestone
