#include "scene/expansion.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace lodestone {

namespace {

float toFloat(double value) {
    constexpr double kLimit = std::numeric_limits<float>::max();
    return static_cast<float>(std::clamp(value, -kLimit, kLimit));
}

glm::vec3 toFloat(const glm::dvec3& v) {
    return {toFloat(v.x), toFloat(v.y), toFloat(v.z)};
}

// Transforms normals rightly under shear, mirror and any scale; exists for singular matrices too.
glm::dmat3 cofactors(const glm::dmat3& m) {
    return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

// First three components of a vertex, whatever their type.
struct AnyVectors {
    static glm::dvec3 at(const Attribute& attribute, std::size_t vertex) {
        return {attributeValue(attribute, vertex, 0),
                attributeValue(attribute, vertex, 1),
                attributeValue(attribute, vertex, 2)};
    }

    static void set(Attribute& attribute, std::size_t vertex, const glm::vec3& value) {
        for (int c = 0; c < 3; ++c)
            setAttributeValue(attribute, vertex, static_cast<std::size_t>(c), value[c]);
    }
};

// The same for floats, several times as fast.
struct FloatVectors {
    static glm::dvec3 at(const Attribute& attribute, std::size_t vertex) {
        glm::vec3 value;
        std::memcpy(&value, attribute.bytes.data() + vertex * attribute.stride(), sizeof value);
        return value;
    }

    static void set(Attribute& attribute, std::size_t vertex, const glm::vec3& value) {
        std::memcpy(attribute.bytes.data() + vertex * attribute.stride(), &value, sizeof value);
    }
};

// Unit vectors of `from` through `matrix`, unit again; one that vanishes stays as it was.
template <class Vectors>
void transformVectors(Attribute& to,
                      std::size_t first_vertex,
                      const Attribute& from,
                      const glm::dmat3& matrix) {
    const std::size_t count = from.bytes.size() / from.stride();
    for (std::size_t v = 0; v < count; ++v) {
        const glm::dvec3 before = Vectors::at(from, v);
        const glm::dvec3 after = matrix * before;
        const double length = glm::length(after);
        const bool usable = std::isfinite(length) && length > 0.0;
        Vectors::set(to, first_vertex + v, glm::vec3(usable ? after / length : before));
    }
}

void transformDirections(Attribute& to,
                         std::size_t first_vertex,
                         const Attribute& from,
                         const glm::dmat3& matrix) {
    if (from.type == ComponentType::Float32)
        transformVectors<FloatVectors>(to, first_vertex, from, matrix);
    else
        transformVectors<AnyVectors>(to, first_vertex, from, matrix);
}

void flipHandedness(Attribute& tangents, std::size_t first_vertex, std::size_t count) {
    for (std::size_t v = first_vertex; v < first_vertex + count; ++v)
        setAttributeValue(tangents, v, 3, -attributeValue(tangents, v, 3));
}

} // namespace

void appendTransformed(Geometry& to,
                       const ExpandPlace& place,
                       const Geometry& from,
                       const glm::dmat4& transform) {
    const glm::dmat3 linear(transform);
    const glm::dvec3 offset(transform[3]);
    const bool mirrored = glm::determinant(linear) < 0.0;
    const std::size_t count = from.positions.size();
    for (std::size_t v = 0; v < count; ++v)
        to.positions[place.first_vertex + v] =
            toFloat(linear * glm::dvec3(from.positions[v]) + offset);
    for (std::size_t a = 0; a < from.attributes.size(); ++a) {
        const Attribute& source = from.attributes[a];
        Attribute& target = to.attributes[a];
        const std::size_t first_byte = place.first_vertex * source.stride();
        std::ranges::copy(source.bytes,
                          target.bytes.begin() + static_cast<std::ptrdiff_t>(first_byte));
        if (source.semantic == "NORMAL" && source.components == 3) {
            const glm::dmat3 matrix = cofactors(linear) * (mirrored ? -1.0 : 1.0);
            transformDirections(target, place.first_vertex, source, matrix);
        } else if (source.semantic == "TANGENT" && source.components == 4) {
            transformDirections(target, place.first_vertex, source, linear);
            if (mirrored)
                flipHandedness(target, place.first_vertex, count);
        }
    }
    for (std::size_t i = 0; i + 2 < from.indices.size(); i += 3) {
        const std::size_t at = place.first_index + i;
        to.indices[at] = place.first_vertex + from.indices[i];
        to.indices[at + 1] = place.first_vertex + from.indices[i + (mirrored ? 2 : 1)];
        to.indices[at + 2] = place.first_vertex + from.indices[i + (mirrored ? 1 : 2)];
    }
}

} // namespace lodestone
