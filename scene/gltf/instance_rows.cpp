#include "scene/gltf/instance_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

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

using ByteQuat = std::array<std::int8_t, 4>;

// A rotation in bytes and what is wrong with it.
struct RoundedTurn {
    ByteQuat bytes{};
    glm::dquat turn{1.0, 0.0, 0.0, 0.0};
    double angle = std::numeric_limits<double>::infinity(); // radians
    // A viewer may not see to it that the length is 1. Then the turn R becomes
    // 1 + length^2 (R - 1): a point at distance 1 is off by that.
    double stretch = 0.0;

    double off() const { return angle + stretch; }
};

// at: on the grid of 1/127.
RoundedTurn roundedTo(const glm::dquat& q, const glm::dvec4& at) {
    constexpr double kMost = 127.0;
    RoundedTurn rounded;
    const double length = glm::length(at) / kMost;
    if (!(length > 0.0))
        return rounded;
    for (int c = 0; c < 4; ++c)
        rounded.bytes[static_cast<std::size_t>(c)] = static_cast<std::int8_t>(at[c]);
    rounded.turn = glm::normalize(glm::dquat(at.w, at.x, at.y, at.z));
    const double apart = 0.5 * glm::length(rounded.turn - q);
    rounded.angle = 4.0 * std::asin(std::min(1.0, apart));
    rounded.stretch =
        2.0 * glm::length(glm::dvec3(q.x, q.y, q.z)) * std::abs(length * length - 1.0);
    return rounded;
}

// The one of the sixteen neighbours on the grid that is off least.
RoundedTurn nearestInBytes(const glm::dquat& q) {
    constexpr double kMost = 127.0;
    const glm::dvec4 below = glm::floor(glm::dvec4(q.x, q.y, q.z, q.w) * kMost);
    RoundedTurn best;
    for (unsigned corner = 0; corner < 16; ++corner) {
        const glm::dvec4 step(corner & 1U, corner >> 1U & 1U, corner >> 2U & 1U, corner >> 3U & 1U);
        const RoundedTurn rounded = roundedTo(q, glm::clamp(below + step, -kMost, kMost));
        if (rounded.off() < best.off())
            best = rounded;
    }
    return best;
}

double largestOf(const glm::dvec3& scale) {
    const glm::dvec3 size = glm::abs(scale);
    return std::max({size.x, size.y, size.z});
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
        const double moved = angleBetween(q, shorts.back()) * reach.distance * largestOf(trs.scale);
        fits = fits && moved <= reach.tolerance;
    }
    if (fits)
        return {"\"ROTATION\":",
                "\"componentType\":5122,\"normalized\":true,\"type\":\"VEC4\"",
                8,
                toBytes(shorts)};
    return {"\"ROTATION\":", "\"componentType\":5126,\"type\":\"VEC4\"", 16, toBytes(floats)};
}

std::vector<GroupAttribute> coarseAttributes(std::span<const Trs> rows, const RowReach& reach) {
    std::vector<ByteQuat> rotations;
    std::vector<glm::vec3> translations;
    for (const Trs& trs : rows) {
        const RoundedTurn rounded = nearestInBytes(trs.rotation);
        const double moved = rounded.angle * reach.radius + rounded.stretch * reach.distance;
        if (moved * largestOf(trs.scale) > reach.tolerance)
            return {};
        const glm::dvec3 center = trs.scale * reach.center;
        rotations.push_back(rounded.bytes);
        translations.emplace_back(trs.translation + trs.rotation * center - rounded.turn * center);
    }
    std::vector<GroupAttribute> attributes;
    attributes.push_back({"\"TRANSLATION\":",
                          "\"componentType\":5126,\"type\":\"VEC3\"",
                          12,
                          toBytes(translations)});
    attributes.push_back({"\"ROTATION\":",
                          "\"componentType\":5120,\"normalized\":true,\"type\":\"VEC4\"",
                          4,
                          toBytes(rotations)});
    return attributes;
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

} // namespace lodestone
