#include "scene/gltf/quantization.h"

#include "scene/gltf/json_sink.h"
#include "scene/gltf/source_document.h"
#include "scene/gltf/writer_references.h"
#include "scene/scene_builder.h"
#include "scene/transformed_box.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace lodestone {

using nlohmann::json;

namespace {

constexpr double kMargin = 1.125;   // of the extent, for LODs that reach beyond the original
constexpr double kReach = 32767.0;  // largest stored number either way
constexpr int kMostPackedBits = 14; // of an extent
constexpr int kFewestPackedBits = 10;
constexpr int kSceneBits = 16; // of the scene's diagonal

double largestComponent(const glm::dvec3& v) {
    return std::max({v.x, v.y, v.z});
}

// Greatest factor by which an instance of each submesh stretches lengths along an axis.
std::vector<double> largestScales(const Scene& scene) {
    std::vector<double> scales(scene.submeshes.size(), 0.0);
    for (const Instance& instance : scene.instances)
        for (int column = 0; column < 3; ++column)
            scales[instance.submesh] = std::max(
                scales[instance.submesh], glm::length(glm::dvec3(instance.transform[column])));
    return scales;
}

bool isPlain(const Submesh& submesh) {
    return std::ranges::all_of(submesh.primitives, [](const Primitive& primitive) {
        return primitive.position_type == ComponentType::Float32 &&
               primitive.geometry->morph_targets.empty();
    });
}

std::uint32_t meshOf(const json& node) {
    const auto found = node.find("mesh");
    return found != node.end() && found->is_number_unsigned() ? found->get<std::uint32_t>() : kNone;
}

bool hasRows(const json& node) {
    const auto found = node.find("extensions");
    return found != node.end() && found->contains(kGpuInstancing);
}

// Submeshes that can take a grid.
std::vector<bool> eligible(const Scene& scene) {
    std::vector<bool> fits;
    for (const Submesh& submesh : scene.submeshes)
        fits.push_back(isPlain(submesh));
    const json& document = scene.source->json;
    const auto nodes = document.find("nodes");
    if (nodes == document.end())
        return fits;
    std::vector<bool> drawn(nodes->size(), false);
    for (const Instance& instance : scene.instances)
        drawn[scene.source->node_of_node[instance.node]] = true;
    std::set<std::uint32_t> unfit; // meshes
    for (std::size_t n = 0; n < nodes->size(); ++n) {
        const json& node = (*nodes)[n];
        if (node.contains("skin") || (hasRows(node) && !drawn[n]))
            unfit.insert(meshOf(node));
    }
    for (std::size_t s = 0; s < fits.size(); ++s)
        fits[s] = fits[s] && !unfit.contains(scene.source->mesh_of_submesh[s]);
    return fits;
}

// With the margin that a grid has around its bounds.
Bounds padded(const Bounds& bounds) {
    const glm::dvec3 more = bounds.size() * (0.5 * (kMargin - 1.0));
    Bounds wider = bounds;
    wider.add(bounds.min - more);
    wider.add(bounds.max + more);
    return wider;
}

double powerOfTwoAtLeast(double value) {
    return std::exp2(std::ceil(std::log2(value)));
}

json shortNumbers(const glm::dvec3& v) {
    return json::array({shortNumber(v.x), shortNumber(v.y), shortNumber(v.z)});
}

glm::dvec3 vectorAt(const json& node, const char* key, const glm::dvec3& otherwise) {
    const auto found = node.find(key);
    if (found == node.end())
        return otherwise;
    return {(*found)[0].get<double>(), (*found)[1].get<double>(), (*found)[2].get<double>()};
}

void composeMatrix(json& matrix, const PositionGrid& grid) {
    glm::dmat4 local;
    for (int i = 0; i < 16; ++i)
        local[i / 4][i % 4] = matrix[static_cast<std::size_t>(i)].get<double>();
    local = local * gridMatrix(grid);
    for (int i = 0; i < 16; ++i)
        matrix[static_cast<std::size_t>(i)] = shortNumber(local[i / 4][i % 4]);
}

void compose(json& node, const PositionGrid& grid) {
    if (const auto matrix = node.find("matrix"); matrix != node.end())
        return composeMatrix(*matrix, grid);
    const glm::dvec3 scale = vectorAt(node, "scale", glm::dvec3(1.0));
    glm::dvec3 moved = scale * grid.offset;
    if (const auto r = node.find("rotation"); r != node.end())
        moved = glm::normalize(glm::dquat((*r)[3].get<double>(),
                                          (*r)[0].get<double>(),
                                          (*r)[1].get<double>(),
                                          (*r)[2].get<double>())) *
                moved;
    if (grid.offset != glm::dvec3(0.0))
        node["translation"] = shortNumbers(vectorAt(node, "translation", glm::dvec3(0.0)) + moved);
    node["scale"] = shortNumbers(scale * grid.step);
}

// Nothing but its mesh depends on its transform.
bool isPlainLeaf(const json& node) {
    return std::ranges::none_of(std::array{"children", "camera", "extras", "extensions"},
                                [&](const char* key) { return node.contains(key); });
}

} // namespace

double shortNumber(double value) {
    const std::string text = shortestNumber(static_cast<float>(value));
    double number = 0.0;
    std::from_chars(text.data(), text.data() + text.size(), number);
    return number;
}

glm::dmat4 gridMatrix(const PositionGrid& grid) {
    return glm::scale(glm::translate(glm::dmat4(1.0), grid.offset), glm::dvec3(grid.step));
}

bool covers(const PositionGrid& grid, const Bounds& bounds) {
    if (bounds.empty || grid.step == 0.0)
        return true;
    const glm::dvec3 reach =
        glm::max(glm::abs(bounds.min - grid.offset), glm::abs(bounds.max - grid.offset));
    return largestComponent(reach) <= kReach * grid.step;
}

double boxDiagonal(const Scene& scene) {
    std::vector<Bounds> local;
    for (const Submesh& submesh : scene.submeshes)
        local.push_back(localBounds(submesh));
    Bounds world;
    for (const Instance& instance : scene.instances) {
        const Bounds& box = local[instance.submesh];
        if (box.empty)
            continue;
        const Bounds placed = transformedBox(instance.transform, box);
        world.add(placed.min);
        world.add(placed.max);
    }
    return world.empty ? 0.0 : world.diagonal();
}

std::vector<Bounds> submeshBounds(const Scene& scene, const Bounds& merged) {
    std::vector<Bounds> bounds;
    for (const Submesh& submesh : scene.submeshes) {
        bounds.push_back(localBounds(submesh));
        if (bounds.back().empty)
            bounds.back() = merged;
    }
    return bounds;
}

std::vector<PositionGrid>
planGrids(const Scene& scene, Compression compression, std::span<const Bounds> bounds) {
    std::vector<PositionGrid> grids(scene.submeshes.size());
    if (compression != Compression::Quantize && compression != Compression::Meshopt)
        return grids;
    const std::vector<bool> fits = eligible(scene);
    const std::vector<double> scales = largestScales(scene);
    double diagonal = boxDiagonal(scene);
    if (diagonal == 0.0) // merged geometry has no vertices yet
        for (const Bounds& box : bounds)
            diagonal = std::max(diagonal, box.empty ? 0.0 : box.diagonal());
    for (std::size_t s = 0; s < grids.size(); ++s) {
        const double extent = bounds[s].empty ? 0.0 : largestComponent(bounds[s].size());
        if (!fits[s] || !(extent > 0.0) || !std::isfinite(extent))
            continue;
        double step = extent * kMargin / (2.0 * kReach);
        if (compression == Compression::Meshopt) {
            const double wanted =
                scales[s] > 0.0 ? diagonal / scales[s] / std::exp2(kSceneBits) : 0.0;
            step = std::max({step,
                             extent * std::exp2(-kMostPackedBits),
                             std::min(wanted, extent * std::exp2(-kFewestPackedBits))});
        }
        grids[s].step = powerOfTwoAtLeast(step);
        // Without an offset the translations of nodes and rows stay what they are.
        if (!covers(grids[s], padded(bounds[s])))
            grids[s].offset = glm::dvec3(glm::vec3(bounds[s].center()));
    }
    return grids;
}

StoredType storedType(const Attribute& attribute, Compression compression) {
    const StoredType own{attribute.type, attribute.normalized};
    if (attribute.type != ComponentType::Float32 || attribute.bytes.empty())
        return own;
    if (compression != Compression::Quantize && compression != Compression::Meshopt)
        return own;
    const std::string_view semantic = attribute.semantic;
    if (semantic == "NORMAL" || semantic == "TANGENT")
        return {ComponentType::Int8, true};
    const bool is_texcoord = semantic.starts_with("TEXCOORD_");
    // Packed texture coordinates stay floats: on a grid they pack as well, and may leave 0..1.
    if (!semantic.starts_with("COLOR_") && (!is_texcoord || compression == Compression::Meshopt))
        return own;
    for (std::size_t v = 0; v < attribute.bytes.size() / attribute.stride(); ++v)
        for (std::size_t c = 0; c < attribute.components; ++c)
            if (const float value = attributeValue(attribute, v, c);
                !(value >= 0.0f && value <= 1.0f))
                return own;
    return {ComponentType::UInt16, true};
}

Attribute storedAttribute(const Attribute& attribute, const StoredType& stored) {
    if (stored.type == attribute.type && stored.normalized == attribute.normalized)
        return attribute;
    Attribute rounded;
    rounded.semantic = attribute.semantic;
    rounded.type = stored.type;
    rounded.components = attribute.components;
    rounded.normalized = stored.normalized;
    const std::size_t count = attribute.bytes.size() / attribute.stride();
    rounded.bytes.resize(count * rounded.stride());
    for (std::size_t v = 0; v < count; ++v)
        for (std::size_t c = 0; c < attribute.components; ++c) {
            const float value = attributeValue(attribute, v, c);
            setAttributeValue(rounded, v, c, std::isfinite(value) ? value : 0.0f);
        }
    return rounded;
}

std::vector<std::uint32_t> applyGrids(json& document,
                                      const Scene& scene,
                                      std::span<const PositionGrid> grids,
                                      const std::set<std::uint32_t>& references) {
    const std::size_t count = document.contains("nodes") ? document["nodes"].size() : 0;
    std::vector<std::uint32_t> drawn_by(count);
    std::map<std::uint32_t, PositionGrid> grid_of_mesh;
    for (std::size_t s = 0; s < grids.size(); ++s)
        if (grids[s].step > 0.0)
            grid_of_mesh[scene.source->mesh_of_submesh[s]] = grids[s];
    for (std::uint32_t n = 0; n < count; ++n) {
        drawn_by[n] = n;
        json& node = document["nodes"][n];
        const auto grid = grid_of_mesh.find(meshOf(node));
        if (grid == grid_of_mesh.end() || hasRows(node))
            continue;
        if (!references.contains(n) && isPlainLeaf(node)) {
            compose(node, grid->second);
            continue;
        }
        json child{{"mesh", grid->first}};
        compose(child, grid->second);
        drawn_by[n] = static_cast<std::uint32_t>(document["nodes"].size());
        node.erase("mesh");
        node["children"].push_back(drawn_by[n]);
        document["nodes"].push_back(std::move(child));
    }
    return drawn_by;
}

} // namespace lodestone
