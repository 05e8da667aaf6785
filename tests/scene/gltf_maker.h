#pragma once
// Makes small glTF files in a folder of their own.
#include "scene/import.h"

#include <cstring>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace lodestone::tests {

// A folder that goes away with the test.
class TempFolder {
public:
    TempFolder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "lodestoneXXXXXX").string();
        path_ = mkdtemp(pattern.data());
    }

    ~TempFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }

    TempFolder(const TempFolder&) = delete;
    TempFolder& operator=(const TempFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

    std::filesystem::path write(const std::string& name, std::string_view content) const {
        std::filesystem::create_directories((path_ / name).parent_path());
        std::ofstream(path_ / name, std::ios::binary) << content;
        return path_ / name;
    }

private:
    std::filesystem::path path_;
};

// Starts as an empty document with one scene; tests add what they are about to `json`.
class GltfMaker {
public:
    nlohmann::json json = {{"asset", {{"version", "2.0"}}},
                           {"scene", 0},
                           {"scenes", {{{"nodes", nlohmann::json::array()}}}}};
    std::string buffer;

    template <class T>
    std::size_t addView(const std::vector<T>& values) {
        buffer.resize((buffer.size() + 3) / 4 * 4);
        const std::size_t offset = buffer.size();
        const std::size_t size = values.size() * sizeof(T);
        buffer.append(reinterpret_cast<const char*>(values.data()), size);
        json["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", size}});
        return json["bufferViews"].size() - 1;
    }

    // Returns the accessor's index. components: of type, by its length ("VEC3": 3).
    template <class T>
    std::size_t
    addAccessor(const std::vector<T>& values, int component_type, const std::string& type) {
        const std::size_t components =
            type == "SCALAR" ? 1 : static_cast<std::size_t>(type[3] - '0');
        const std::size_t view = addView(values);
        json["accessors"].push_back({{"bufferView", view},
                                     {"componentType", component_type},
                                     {"count", values.size() / components},
                                     {"type", type}});
        return json["accessors"].size() - 1;
    }

    // A mesh of one primitive; indices of no element: none in the file.
    std::size_t addMesh(const std::vector<float>& positions,
                        const std::vector<std::uint16_t>& indices,
                        int mode = 4) {
        nlohmann::json primitive{
            {"attributes", {{"POSITION", addAccessor(positions, 5126, "VEC3")}}}, {"mode", mode}};
        if (!indices.empty())
            primitive["indices"] = addAccessor(indices, 5123, "SCALAR");
        json["meshes"].push_back({{"primitives", nlohmann::json::array({primitive})}});
        return json["meshes"].size() - 1;
    }

    // Unit right triangle in the xy plane.
    std::size_t addTriangle() { return addMesh({0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 2}); }

    // A node; roots go into the scene.
    std::size_t addNode(nlohmann::json node, bool is_root = true) {
        json["nodes"].push_back(std::move(node));
        const std::size_t index = json["nodes"].size() - 1;
        if (is_root)
            json["scenes"][0]["nodes"].push_back(index);
        return index;
    }

    std::string glb() const {
        nlohmann::json document = json;
        if (!buffer.empty())
            document["buffers"] = {{{"byteLength", buffer.size()}}};
        std::string text = document.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        std::string binary = buffer;
        binary.resize((binary.size() + 3) / 4 * 4, '\0');
        std::string file = "glTF";
        const auto put = [&file](std::size_t value) {
            const auto word = static_cast<std::uint32_t>(value);
            file.append(reinterpret_cast<const char*>(&word), sizeof word);
        };
        put(2);
        put(12 + 8 + text.size() + (binary.empty() ? 0 : 8 + binary.size()));
        put(text.size());
        file += "JSON" + text;
        if (!binary.empty()) {
            put(binary.size());
            file += std::string("BIN\0", 4) + binary;
        }
        return file;
    }

    Result<ScenePtr> import() const {
        const TempFolder folder;
        return importScene(folder.write("made.glb", glb()), {});
    }

    // The scene, which the test takes for readable.
    ScenePtr scene() const {
        Result<ScenePtr> scene = import();
        if (!scene)
            throw std::runtime_error(scene.error().message);
        return *scene;
    }
};

} // namespace lodestone::tests
