#include "scene/assimp/fold_equal.h"

#include <algorithm>
#include <cstring>
#include <unordered_map>

namespace lodestone {

namespace {

template <class Value>
std::string_view bytesOf(const std::vector<Value>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)};
}

std::size_t combined(std::size_t seed, std::size_t value) {
    return seed ^ (value + 0x9E3779B97F4A7C15ull + (seed << 6) + (seed >> 2));
}

std::size_t hashOf(const Submesh& submesh) {
    const std::hash<std::string_view> hash;
    std::size_t result = submesh.primitives.size();
    for (const Primitive& primitive : submesh.primitives) {
        const Geometry& geometry = *primitive.geometry;
        result = combined(result, primitive.material);
        result = combined(result, hash(bytesOf(geometry.positions)));
        result = combined(result, hash(bytesOf(geometry.indices)));
    }
    return result;
}

bool isEqual(const Attribute& a, const Attribute& b) {
    return a.semantic == b.semantic && a.type == b.type && a.components == b.components &&
           a.normalized == b.normalized && bytesOf(a.bytes) == bytesOf(b.bytes);
}

bool isEqual(const Primitive& a, const Primitive& b) {
    if (a.mode != b.mode || a.material != b.material)
        return false;
    return a.geometry == b.geometry ||
           (bytesOf(a.geometry->positions) == bytesOf(b.geometry->positions) &&
            bytesOf(a.geometry->indices) == bytesOf(b.geometry->indices) &&
            std::ranges::equal(
                a.geometry->attributes,
                b.geometry->attributes,
                [](const Attribute& x, const Attribute& y) { return isEqual(x, y); }));
}

} // namespace

std::vector<std::uint32_t> findEqualSubmeshes(std::span<const Submesh> submeshes) {
    std::vector<std::uint32_t> representative(submeshes.size());
    std::unordered_multimap<std::size_t, std::uint32_t> known;
    for (std::uint32_t s = 0; s < submeshes.size(); ++s) {
        representative[s] = s;
        const std::size_t hash = hashOf(submeshes[s]);
        const auto [first, last] = known.equal_range(hash);
        const auto equal = std::find_if(first, last, [&](const auto& entry) {
            return std::ranges::equal(
                submeshes[entry.second].primitives,
                submeshes[s].primitives,
                [](const Primitive& a, const Primitive& b) { return isEqual(a, b); });
        });
        if (equal != last)
            representative[s] = equal->second;
        else
            known.emplace(hash, s);
    }
    return representative;
}

} // namespace lodestone
