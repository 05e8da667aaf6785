#include "scene/gltf/meshopt_writer.h"

#include "scene/gltf/writer_references.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <meshoptimizer.h>
#include <tuple>

namespace lodestone {

using nlohmann::json;

namespace {

constexpr const char* kExtension = "EXT_meshopt_compression";
constexpr int kDirectionBits = 8;
constexpr int kTexcoordExponent = -13;
constexpr double kRowTolerance = 5e-5; // of the scene's diagonal
constexpr int kFewestRotationBits = 6;
constexpr int kMostRotationBits = 16;
constexpr int kFewestScaleBits = 7;
constexpr int kMantissaBits = 23;
constexpr int kArrayBuffer = 34962;
constexpr int kElementArrayBuffer = 34963;

enum class Filter : std::uint8_t { None, Octahedral, Quaternion, Exponential };

constexpr std::array kFilterNames{"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"};

// What goes into one view.
struct BinKey {
    AccessorUse::Kind kind = AccessorUse::Kind::None;
    Filter filter = Filter::None;
    std::size_t stride = 0;

    bool operator<(const BinKey& other) const {
        return std::tie(kind, filter, stride) < std::tie(other.kind, other.filter, other.stride);
    }
};

// Numbers as 24-bit multiples of a power of two, the exponent in the highest byte.
std::vector<std::byte> onGrid(std::span<const float> values, int exponent) {
    std::vector<std::byte> bytes(values.size() * sizeof(std::uint32_t));
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double steps = std::ldexp(static_cast<double>(values[i]), -exponent);
        const auto mantissa = static_cast<std::int32_t>(std::lround(steps));
        const std::uint32_t packed = (static_cast<std::uint32_t>(mantissa) & 0xFFFFFFU) |
                                     static_cast<std::uint32_t>(exponent) << 24;
        std::memcpy(bytes.data() + i * sizeof packed, &packed, sizeof packed);
    }
    return bytes;
}

// The greatest exponent whose grid is no coarser than the step, as far as the values' mantissas
// reach.
int exponentFor(double step, std::span<const float> values) {
    double most = 0.0;
    for (const float value : values)
        most = std::max(most, static_cast<double>(std::abs(value)));
    const int finest = most > 0.0 ? std::ilogb(most) + 2 - kMantissaBits : -100;
    const int wanted = step > 0.0 ? std::ilogb(step) : finest;
    return std::clamp(std::max(wanted, finest), -100, 100);
}

class MeshoptPacker {
public:
    explicit MeshoptPacker(PackedDocument& document)
        : document_(document), json_(document.json), uses_(accessorUses(document)),
          reach_(nodeReaches()) {}

    void pack() {
        std::map<BinKey, std::vector<std::size_t>> bins;
        for (std::size_t a = 0; a < uses_.size(); ++a)
            if (uses_[a].kind != AccessorUse::Kind::None)
                bins[keyOf(a)].push_back(a);
        if (bins.empty())
            return;
        views_ = json::array();
        for (std::uint32_t v = 0; v < document_.first_view; ++v)
            views_.push_back(json_["bufferViews"][v]);
        const auto carried = std::span(document_.binary).first(document_.first_byte);
        packed_.assign(carried.begin(), carried.end());
        for (const auto& [key, accessors] : bins)
            addView(key, accessors);
        for (const Place& place : places_) {
            json& accessor = json_["accessors"][place.accessor];
            accessor["bufferView"] = place.view;
            accessor["byteOffset"] = place.offset_bytes;
            if (place.offset_bytes == 0)
                accessor.erase("byteOffset");
        }
        json_["bufferViews"] = std::move(views_);
        json_["buffers"][0]["byteLength"] = packed_.size();
        json fallback{{"byteLength", fallback_bytes_}};
        fallback["extensions"][kExtension]["fallback"] = true;
        json_["buffers"].push_back(std::move(fallback));
        requireExtension(json_, kExtension);
        document_.binary = std::move(packed_);
    }

private:
    // How rows of a node move points: lengths of the mesh as stored, and of the world.
    struct Reach {
        double mesh = 0.0;   // farthest point of the mesh from its origin
        double parent = 1.0; // most that the node and its parents stretch
    };

    struct Place {
        std::size_t accessor = 0;
        std::size_t view = 0;
        std::size_t offset_bytes = 0;
    };

    std::vector<Reach> nodeReaches() const {
        const std::vector<double> stretches = nodeStretches(json_);
        std::vector<Reach> reaches(stretches.size());
        for (std::size_t n = 0; n < reaches.size(); ++n) {
            reaches[n].parent = stretches[n];
            const json& node = json_["nodes"][n];
            if (const auto mesh = node.find("mesh"); mesh != node.end())
                reaches[n].mesh = meshReach(json_["meshes"][mesh->get<std::size_t>()]);
        }
        return reaches;
    }

    double meshReach(const json& mesh) const {
        double reach = 0.0;
        for (const json& primitive : mesh["primitives"]) {
            const json& positions =
                json_["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()];
            double squared = 0.0;
            for (std::size_t c = 0; c < 3; ++c) {
                const double far = std::max(std::abs(positions["min"][c].get<double>()),
                                            std::abs(positions["max"][c].get<double>()));
                squared += far * far;
            }
            reach = std::max(reach, std::sqrt(squared));
        }
        return reach;
    }

    BinKey keyOf(std::size_t accessor) const {
        const AccessorUse& use = uses_[accessor];
        const json& entry = json_["accessors"][accessor];
        BinKey key{use.kind, Filter::None, elementsOf(document_, accessor).stride};
        const int type = entry["componentType"];
        if (use.kind == AccessorUse::Kind::Vertex) {
            if ((use.semantic == "NORMAL" || use.semantic == "TANGENT") && type == 5120)
                key.filter = Filter::Octahedral;
            if (use.semantic.starts_with("TEXCOORD_") && type == 5126)
                key.filter = Filter::Exponential;
        } else if (use.kind == AccessorUse::Kind::Row) {
            if (use.semantic == "ROTATION" && type == 5122)
                key.filter = Filter::Quaternion;
            if (use.semantic == "TRANSLATION" || use.semantic == "SCALE")
                key.filter = Filter::Exponential;
        }
        return key;
    }

    std::vector<std::byte> filtered(std::size_t accessor, const BinKey& key) const {
        switch (key.filter) {
        case Filter::None: {
            const StridedElements elements = elementsOf(document_, accessor);
            return {elements.bytes.begin(), elements.bytes.end()};
        }
        case Filter::Octahedral:
            return octahedral(accessor, key.stride);
        case Filter::Quaternion:
            return quaternions(accessor);
        case Filter::Exponential:
            break;
        }
        const std::vector<float> values = floatsOf(document_, accessor);
        return onGrid(values, exponentOf(accessor, values));
    }

    std::vector<std::byte> octahedral(std::size_t accessor, std::size_t stride) const {
        const std::vector<float> values = floatsOf(document_, accessor);
        const std::size_t components = componentsOf(json_["accessors"][accessor]);
        const std::size_t count = values.size() / components;
        std::vector<float> padded(count * 4, 0.0f);
        for (std::size_t i = 0; i < count; ++i)
            std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(i * components),
                        components,
                        padded.begin() + static_cast<std::ptrdiff_t>(i * 4));
        std::vector<std::byte> bytes(count * stride);
        meshopt_encodeFilterOct(bytes.data(), count, stride, kDirectionBits, padded.data());
        return bytes;
    }

    // World units that a point may move.
    double tolerance(const AccessorUse& use) const {
        return document_.diagonal * kRowTolerance / reach_[use.node].parent;
    }

    std::vector<std::byte> quaternions(std::size_t accessor) const {
        const AccessorUse& use = uses_[accessor];
        std::vector<float> values = floatsOf(document_, accessor);
        // K bits are off by less than sqrt(2) / 2^(K - 1) rad.
        const double distance = reach_[use.node].mesh * largestRowScale(document_, use.node);
        const double turn = tolerance(use) > 0.0 ? distance / tolerance(use) : 0.0;
        const int bits = turn > 0.0
                             ? static_cast<int>(std::ceil(std::log2(std::sqrt(2.0) * turn))) + 1
                             : kMostRotationBits;
        for (std::size_t i = 0; i < values.size(); i += 4) {
            const double length = std::hypot(std::hypot(values[i], values[i + 1]),
                                             std::hypot(values[i + 2], values[i + 3]));
            for (std::size_t c = 0; c < 4 && length > 0.0; ++c)
                values[i + c] = static_cast<float>(static_cast<double>(values[i + c]) / length);
        }
        std::vector<std::byte> bytes(values.size() / 4 * 8);
        meshopt_encodeFilterQuat(bytes.data(),
                                 values.size() / 4,
                                 8,
                                 std::clamp(bits, kFewestRotationBits, kMostRotationBits),
                                 values.data());
        return bytes;
    }

    int exponentOf(std::size_t accessor, std::span<const float> values) const {
        const AccessorUse& use = uses_[accessor];
        if (use.kind == AccessorUse::Kind::Vertex)
            return std::max(kTexcoordExponent, exponentFor(0.0, values));
        if (use.semantic == "TRANSLATION")
            return exponentFor(2.0 / std::sqrt(3.0) * tolerance(use), values);
        double least = std::numeric_limits<double>::infinity();
        for (const float value : values)
            if (value != 0.0f)
                least = std::min(least, static_cast<double>(std::abs(value)));
        double step = std::ldexp(least, -kFewestScaleBits);
        if (const double reach = reach_[use.node].mesh; reach > 0.0)
            step = std::min(step, 2.0 * tolerance(use) / reach);
        return exponentFor(std::isfinite(step) ? step : 0.0, values);
    }

    std::vector<std::byte> encoded(const BinKey& key,
                                   std::span<const std::byte> bytes,
                                   std::span<const std::uint32_t> indices) const {
        std::vector<unsigned char> code;
        if (key.kind == AccessorUse::Kind::Vertex || key.kind == AccessorUse::Kind::Row) {
            const std::size_t count = bytes.size() / key.stride;
            code.resize(meshopt_encodeVertexBufferBound(count, key.stride));
            code.resize(meshopt_encodeVertexBuffer(
                code.data(), code.size(), bytes.data(), count, key.stride));
        } else {
            const std::size_t vertices =
                indices.empty() ? 0 : std::size_t{*std::ranges::max_element(indices)} + 1;
            const unsigned int* const from = indices.data();
            const std::size_t count = indices.size();
            if (key.kind == AccessorUse::Kind::Triangles) {
                code.resize(meshopt_encodeIndexBufferBound(count, vertices));
                code.resize(meshopt_encodeIndexBuffer(code.data(), code.size(), from, count));
            } else {
                code.resize(meshopt_encodeIndexSequenceBound(count, vertices));
                code.resize(meshopt_encodeIndexSequence(code.data(), code.size(), from, count));
            }
        }
        const auto* first = reinterpret_cast<const std::byte*>(code.data());
        return {first, first + code.size()};
    }

    void addView(const BinKey& key, std::span<const std::size_t> accessors) {
        const bool is_index =
            key.kind == AccessorUse::Kind::Triangles || key.kind == AccessorUse::Kind::Indices;
        std::vector<std::byte> bytes;
        std::vector<std::uint32_t> indices;
        std::size_t count = 0;
        for (const std::size_t a : accessors) {
            if (is_index) {
                const std::vector<std::uint32_t> own = indicesOf(document_, a);
                indices.insert(indices.end(), own.begin(), own.end());
            } else {
                const std::vector<std::byte> own = filtered(a, key);
                bytes.insert(bytes.end(), own.begin(), own.end());
            }
            places_.push_back({a, views_.size(), count * key.stride});
            count += elementsOf(document_, a).count;
        }
        const std::vector<std::byte> code = encoded(key, bytes, indices);
        json words{{"buffer", 0},
                   {"byteOffset", packed_.size()},
                   {"byteLength", code.size()},
                   {"byteStride", key.stride},
                   {"count", count},
                   {"mode",
                    key.kind == AccessorUse::Kind::Triangles ? "TRIANGLES"
                    : is_index                               ? "INDICES"
                                                             : "ATTRIBUTES"}};
        if (key.filter != Filter::None)
            words["filter"] = kFilterNames[static_cast<std::size_t>(key.filter)];
        json view{
            {"buffer", 1}, {"byteOffset", fallback_bytes_}, {"byteLength", count * key.stride}};
        if (key.kind != AccessorUse::Kind::Row)
            view["target"] = is_index ? kElementArrayBuffer : kArrayBuffer;
        if (key.kind == AccessorUse::Kind::Vertex)
            view["byteStride"] = key.stride;
        view["extensions"][kExtension] = std::move(words);
        views_.push_back(std::move(view));
        fallback_bytes_ = (fallback_bytes_ + count * key.stride + 3) & ~std::size_t{3};
        packed_.insert(packed_.end(), code.begin(), code.end());
        padTo4(packed_);
        if (key.kind == AccessorUse::Kind::Row)
            document_.row_bytes += (code.size() + 3) & ~std::size_t{3};
    }

    PackedDocument& document_;
    json& json_;
    std::vector<AccessorUse> uses_;
    std::vector<Reach> reach_;  // [nodes]
    std::vector<Place> places_; // where accessors go once all are read
    json views_;
    std::vector<std::byte> packed_;
    std::size_t fallback_bytes_ = 0;
};

} // namespace

void packMeshopt(PackedDocument& document) {
    MeshoptPacker(document).pack();
}

} // namespace lodestone
