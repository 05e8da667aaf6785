#include "render/gpu_geometry.h"
#include "render/renderer_state.h"
#include "render/smooth_normals.h"
#include "scene/vertex_value.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <span>
#include <utility>

namespace lodestone {

namespace {

constexpr std::size_t kFrameSamples = 4096;
constexpr std::size_t kMostMorphTexels = std::size_t{1} << 26u; // every GL that is used has them
constexpr double kFarthest = 1e15; // local units; beyond, products overflow a float

double median(std::vector<double>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

const Attribute* usable(const Geometry& geometry, std::string_view semantic, int components) {
    const Attribute* attribute = findAttribute(geometry.attributes, semantic);
    if (attribute == nullptr || attribute->components < components ||
        attribute->bytes.size() < attribute->stride() * geometry.positions.size())
        return nullptr;
    return attribute;
}

float finite(float value) {
    return std::isfinite(value) ? value : 0.0f;
}

// Writes the first `components` components of an attribute as floats into interleaved vertices.
struct Interleaved {
    std::span<std::byte> bytes;
    std::size_t stride = 0;
    std::size_t offset = 0;
};

void putFloats(const Interleaved& out, const Attribute& attribute, std::size_t components) {
    const std::size_t count = out.bytes.size() / out.stride;
    const bool copy = attribute.type == ComponentType::Float32;
    for (std::size_t v = 0; v < count; ++v) {
        float values[4] = {0.0f, 0.0f, 0.0f, 0.0f};
        if (copy)
            std::memcpy(
                values, &attribute.bytes[v * attribute.stride()], components * sizeof(float));
        else
            for (std::size_t c = 0; c < components; ++c)
                values[c] = attributeValue(attribute, v, c);
        for (std::size_t c = 0; c < components; ++c)
            values[c] = finite(values[c]);
        std::memcpy(&out.bytes[v * out.stride + out.offset], values, components * sizeof(float));
    }
}

void putColors(const Interleaved& out, const Attribute& attribute) {
    const std::size_t count = out.bytes.size() / out.stride;
    for (std::size_t v = 0; v < count; ++v) {
        std::uint16_t values[4] = {0, 0, 0, 65535};
        for (std::size_t c = 0; c < std::min<std::size_t>(attribute.components, 4); ++c) {
            const float value = std::clamp(finite(attributeValue(attribute, v, c)), 0.0f, 1.0f);
            values[c] = static_cast<std::uint16_t>(std::lround(value * 65535.0f));
        }
        std::memcpy(&out.bytes[v * out.stride + out.offset], values, sizeof values);
    }
}

void putJoints(const Interleaved& out, const Attribute& attribute) {
    const std::size_t count = out.bytes.size() / out.stride;
    for (std::size_t v = 0; v < count; ++v) {
        std::uint16_t values[4] = {0, 0, 0, 0};
        for (std::size_t c = 0; c < 4; ++c)
            values[c] = static_cast<std::uint16_t>(
                std::clamp(finite(attributeValue(attribute, v, c)), 0.0f, 65535.0f));
        std::memcpy(&out.bytes[v * out.stride + out.offset], values, sizeof values);
    }
}

void putPositions(const Interleaved& out, const Geometry& geometry, const LocalFrame& frame) {
    const double inverse = 1.0 / frame.scale;
    for (std::size_t v = 0; v < geometry.positions.size(); ++v) {
        const glm::dvec3 local = (glm::dvec3(geometry.positions[v]) - frame.center) * inverse;
        const glm::vec3 position(glm::clamp(local, glm::dvec3(-kFarthest), glm::dvec3(kFarthest)));
        std::memcpy(&out.bytes[v * out.stride + out.offset], &position, sizeof position);
    }
}

template <class Index>
std::vector<std::byte> indexBytes(const Geometry& geometry) {
    std::vector<std::byte> bytes(geometry.indices.size() * sizeof(Index));
    for (std::size_t at = 0; at < geometry.indices.size(); ++at) {
        const auto index = static_cast<Index>(geometry.indices[at]);
        std::memcpy(&bytes[at * sizeof(Index)], &index, sizeof(Index));
    }
    return bytes;
}

void packIndices(const Geometry& geometry, PackedGeometry& packed) {
    constexpr std::size_t kNarrowVertices = 65536;
    packed.index_count = static_cast<std::uint32_t>(geometry.indices.size());
    const bool narrow = geometry.positions.size() <= kNarrowVertices;
    packed.index_type = narrow ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT;
    packed.indices =
        narrow ? indexBytes<std::uint16_t>(geometry) : indexBytes<std::uint32_t>(geometry);
}

} // namespace

LocalFrame localFrame(const Submesh& submesh) {
    std::size_t vertex_count = 0;
    for (const Primitive& primitive : submesh.primitives)
        vertex_count += primitive.geometry->positions.size();
    const std::size_t step = vertex_count / kFrameSamples + 1;
    std::vector<double> axis[3];
    std::size_t index = 0;
    for (const Primitive& primitive : submesh.primitives)
        for (const glm::vec3& position : primitive.geometry->positions)
            if (index++ % step == 0)
                for (int c = 0; c < 3; ++c)
                    axis[c].push_back(position[c]);
    LocalFrame frame;
    if (axis[0].empty())
        return frame;
    double scale = 0.0;
    for (int c = 0; c < 3; ++c) {
        frame.center[c] = median(axis[c]);
        for (double& value : axis[c])
            value = std::abs(value - frame.center[c]);
        scale = std::max(scale, median(axis[c]));
    }
    if (scale > 0.0 && std::isfinite(scale))
        frame.scale = scale;
    return frame;
}

namespace {

// Lays the attributes of a geometry out one after another in each vertex.
class VertexPacker {
public:
    VertexPacker(const Geometry& geometry, PackedGeometry& packed)
        : geometry_(geometry), packed_(packed) {}

    void pack(const LocalFrame& frame) {
        VertexLayout& layout = packed_.layout;
        layout.normal_offset = addFloats("NORMAL", 3, kHasNormal);
        layout.uv0_offset = addFloats("TEXCOORD_0", 2, kHasUv0);
        layout.uv1_offset = addFloats("TEXCOORD_1", 2, kHasUv1);
        layout.color_offset = addColors();
        layout.value_offset = addFloats(kVertexValueSemantic, 1, kHasValue);
        layout.tangent_offset = addFloats("TANGENT", 4, kHasTangent);
        layout.joints_offset[0] = addJoints("JOINTS_0", "WEIGHTS_0", kHasJoints);
        if ((layout.features & kHasJoints) != 0)
            layout.joints_offset[1] = addJoints("JOINTS_1", "WEIGHTS_1", kHasMoreJoints);
        layout.stride_bytes = static_cast<GLsizei>(stride_);
        packed_.vertices.resize(stride_ * geometry_.positions.size());
        putPositions({packed_.vertices, stride_, 0}, geometry_, frame);
        for (const auto& put : puts_)
            put();
        packed_.vertex_count = static_cast<std::uint32_t>(geometry_.positions.size());
    }

private:
    std::size_t reserve(Feature feature, std::size_t size_bytes) {
        packed_.layout.features |= feature;
        return std::exchange(stride_, stride_ + size_bytes);
    }

    Interleaved at(std::size_t offset) const { return {packed_.vertices, stride_, offset}; }

    std::size_t addFloats(std::string_view semantic, int components, Feature feature) {
        const Attribute* attribute = usable(geometry_, semantic, components);
        if (attribute == nullptr)
            return 0;
        const auto count = static_cast<std::size_t>(components);
        const std::size_t offset = reserve(feature, count * sizeof(float));
        puts_.emplace_back([=, this] { putFloats(at(offset), *attribute, count); });
        return offset;
    }

    std::size_t addColors() {
        const Attribute* attribute = usable(geometry_, "COLOR_0", 3);
        if (attribute == nullptr)
            return 0;
        const std::size_t offset = reserve(kHasColor, 4 * sizeof(std::uint16_t));
        puts_.emplace_back([=, this] { putColors(at(offset), *attribute); });
        return offset;
    }

    std::size_t
    addJoints(std::string_view joint_semantic, std::string_view weight_semantic, Feature feature) {
        const Attribute* joints = usable(geometry_, joint_semantic, 4);
        const Attribute* weights = usable(geometry_, weight_semantic, 4);
        if (joints == nullptr || weights == nullptr)
            return 0;
        constexpr std::size_t kJointBytes = 4 * sizeof(std::uint16_t);
        const std::size_t offset = reserve(feature, kJointBytes + 4 * sizeof(float));
        puts_.emplace_back([=, this] {
            putJoints(at(offset), *joints);
            putFloats(at(offset + kJointBytes), *weights, 4);
        });
        return offset;
    }

    const Geometry& geometry_;
    PackedGeometry& packed_;
    std::size_t stride_ = sizeof(glm::vec3);
    std::vector<std::function<void()>> puts_;
};

// Deltas of positions (in the packed frame) and normals; targets without either hold zeros.
void packMorphs(const Geometry& geometry, const LocalFrame& frame, PackedGeometry& packed) {
    const std::size_t count = geometry.positions.size();
    const std::size_t texels = 2 * count * geometry.morph_targets.size();
    if (texels == 0 || texels > kMostMorphTexels)
        return;
    std::vector<glm::vec4> deltas(texels, glm::vec4(0.0f));
    for (std::size_t t = 0; t < geometry.morph_targets.size(); ++t)
        for (const Attribute& attribute : geometry.morph_targets[t].attributes) {
            const bool is_position = attribute.semantic == "POSITION";
            if ((!is_position && attribute.semantic != "NORMAL") || attribute.components != 3 ||
                attribute.bytes.size() < attribute.stride() * count)
                continue;
            const auto factor = static_cast<float>(is_position ? 1.0 / frame.scale : 1.0);
            for (std::size_t v = 0; v < count; ++v)
                for (std::size_t c = 0; c < 3; ++c)
                    deltas[2 * (t * count + v) + (is_position ? 0 : 1)][static_cast<int>(c)] =
                        finite(attributeValue(attribute, v, c) * factor);
        }
    packed.morph_targets = static_cast<std::uint32_t>(geometry.morph_targets.size());
    packed.layout.features |= kMorphed;
    packed.morphs.resize(texels * sizeof(glm::vec4));
    std::memcpy(packed.morphs.data(), deltas.data(), packed.morphs.size());
}

} // namespace

bool lacksNormals(const Geometry& geometry, PrimitiveMode mode) {
    return mode == PrimitiveMode::Triangles && usable(geometry, "NORMAL", 3) == nullptr;
}

PackedGeometry
packGeometry(const GeometryPtr& source, const LocalFrame& frame, PrimitiveMode mode) {
    PackedGeometry packed;
    packed.source = source;
    Bounds box;
    for (const glm::vec3& position : source->positions)
        box.add(glm::dvec3(position));
    packed.source_center = box.center();
    packed.source_radius = box.empty ? 0.0 : box.diagonal() * 0.5;
    const bool smooth = lacksNormals(*source, mode);
    const Geometry smoothed = smooth ? withSmoothNormals(*source) : Geometry();
    const Geometry& geometry = smooth ? smoothed : *source;
    VertexPacker(geometry, packed).pack(frame);
    packMorphs(geometry, frame, packed);
    packIndices(geometry, packed);
    return packed;
}

} // namespace lodestone
