#include "scene/gltf/instance_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numeric>

namespace lodestone {

namespace {

template <class T>
std::vector<std::byte> toBytes(const std::vector<T>& values) {
    std::vector<std::byte> bytes(values.size() * sizeof(T));
    if (!bytes.empty())
        std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}

using ShortQuat = std::array<std::int16_t, 4>;

ShortQuat toShorts(const glm::dquat& q) {
    constexpr double kMost = 32767.0;
    const auto rounded = [](double value) {
        return static_cast<std::int16_t>(std::lround(std::clamp(value, -1.0, 1.0) * kMost));
    };
    return {rounded(q.x), rounded(q.y), rounded(q.z), rounded(q.w)};
}

// Radians between a rotation and its rounded form.
double angleBetween(const glm::dquat& q, const ShortQuat& shorts) {
    const glm::dquat back = glm::normalize(glm::dquat(static_cast<double>(shorts[3]),
                                                      static_cast<double>(shorts[0]),
                                                      static_cast<double>(shorts[1]),
                                                      static_cast<double>(shorts[2])));
    const glm::dquat turn = glm::conjugate(q) * back;
    return 2.0 * std::atan2(glm::length(glm::dvec3(turn.x, turn.y, turn.z)), std::abs(turn.w));
}

// The lowest 21 bits, two zeros before each.
std::uint64_t spread(std::uint64_t bits) {
    bits &= 0x1FFFFF;
    bits = (bits | bits << 32) & 0x001F00000000FFFFULL;
    bits = (bits | bits << 16) & 0x001F0000FF0000FFULL;
    bits = (bits | bits << 8) & 0x100F00F00F00F00FULL;
    bits = (bits | bits << 4) & 0x10C30C30C30C30C3ULL;
    return (bits | bits << 2) & 0x1249249249249249ULL;
}

glm::dvec4 valueAt(const Attribute& attribute, std::size_t row) {
    glm::dvec4 value(0.0);
    for (std::size_t c = 0; c < attribute.components; ++c)
        value[static_cast<int>(c)] = static_cast<double>(attributeValue(attribute, row, c));
    return value;
}

} // namespace

GroupAttribute rotationAttribute(std::span<const Trs> rows, const RowReach& reach) {
    std::vector<ShortQuat> shorts;
    std::vector<glm::vec4> floats;
    bool fits = true;
    for (const Trs& trs : rows) {
        const glm::dquat& q = trs.rotation;
        floats.emplace_back(q.x, q.y, q.z, q.w);
        shorts.push_back(toShorts(q));
        const glm::dvec3 scale = glm::abs(trs.scale);
        const double moved =
            angleBetween(q, shorts.back()) * reach.distance * std::max({scale.x, scale.y, scale.z});
        fits = fits && moved <= reach.tolerance;
    }
    if (fits)
        return {"\"ROTATION\":",
                "\"componentType\":5122,\"normalized\":true,\"type\":\"VEC4\"",
                8,
                toBytes(shorts)};
    return {"\"ROTATION\":", "\"componentType\":5126,\"type\":\"VEC4\"", 16, toBytes(floats)};
}

double takeCommonScale(std::span<Trs> rows) {
    if (rows.empty())
        return 1.0;
    const glm::vec3 first(rows.front().scale);
    const bool uniform = first.x > 0.0f && first == glm::vec3(first.x);
    if (!uniform ||
        !std::ranges::all_of(rows, [&](const Trs& row) { return glm::vec3(row.scale) == first; }))
        return 1.0;
    const auto common = static_cast<double>(first.x);
    for (Trs& row : rows) {
        row.translation /= common;
        row.scale = glm::dvec3(1.0);
    }
    return common;
}

std::vector<GroupAttribute> rowAttributes(std::span<const Trs> rows, const RowReach& reach) {
    std::vector<glm::vec3> scales;
    std::vector<glm::vec3> translations;
    bool turns = false;
    for (const Trs& trs : rows) {
        scales.emplace_back(trs.scale);
        translations.emplace_back(trs.translation);
        turns |= glm::vec4(trs.rotation.x, trs.rotation.y, trs.rotation.z, trs.rotation.w) !=
                 glm::vec4(0, 0, 0, 1);
    }
    const std::string vec3 = "\"componentType\":5126,\"type\":\"VEC3\"";
    std::vector<GroupAttribute> attributes;
    attributes.push_back({"\"TRANSLATION\":", vec3, 12, toBytes(translations)});
    if (turns)
        attributes.push_back(rotationAttribute(rows, reach));
    if (std::ranges::any_of(scales, [](const glm::vec3& s) { return s != glm::vec3(1.0f); }))
        attributes.push_back({"\"SCALE\":", vec3, 12, toBytes(scales)});
    return attributes;
}

std::vector<Trs> rowTransforms(std::span<const RowColumn> columns, std::size_t row_count) {
    std::vector<Trs> rows(row_count);
    for (const RowColumn& column : columns)
        for (std::size_t row = 0; row < row_count; ++row) {
            const glm::dvec4 value = valueAt(column.values, row);
            if (column.name == "TRANSLATION") {
                rows[row].translation = glm::dvec3(value);
            } else if (column.name == "SCALE") {
                rows[row].scale = glm::dvec3(value);
            } else if (column.name == "ROTATION") {
                const glm::dquat q(value.w, value.x, value.y, value.z);
                const double length = glm::length(q);
                if (length > 0.0 && std::isfinite(length))
                    rows[row].rotation = q / length;
            }
        }
    return rows;
}

std::vector<std::uint32_t> mortonOrder(std::span<const glm::dvec3> translations) {
    Bounds bounds;
    for (const glm::dvec3& at : translations)
        bounds.add(at);
    const glm::dvec3 size = bounds.size();
    const double extent = std::max({size.x, size.y, size.z});
    const double cells = extent > 0.0 && std::isfinite(extent) ? 2097151.0 / extent : 0.0;
    std::vector<std::uint64_t> keys;
    for (const glm::dvec3& at : translations) {
        const glm::dvec3 cell = (at - bounds.min) * cells;
        keys.push_back(spread(static_cast<std::uint64_t>(cell.x)) |
                       spread(static_cast<std::uint64_t>(cell.y)) << 1 |
                       spread(static_cast<std::uint64_t>(cell.z)) << 2);
    }
    std::vector<std::uint32_t> order(translations.size());
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::stable_sort(order, {}, [&](std::uint32_t row) { return keys[row]; });
    return order;
}

} // namespace lodestone
