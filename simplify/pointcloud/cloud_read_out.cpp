#include "simplify/pointcloud/cloud_read_out.h"

#include <algorithm>
#include <cstring>

namespace lodestone {

namespace {

// Of the wedges that are left, in order: vertices of the file.
Attribute carried(const Attribute& from, std::span<const std::uint32_t> sources) {
    Attribute to{from.semantic, from.type, from.components, from.normalized, {}};
    const std::size_t stride = from.stride();
    to.bytes.resize(sources.size() * stride);
    for (std::size_t i = 0; i < sources.size(); ++i)
        std::memcpy(to.bytes.data() + i * stride, from.bytes.data() + sources[i] * stride, stride);
    return to;
}

// Everything but the indices. vertex_of: [wedges], filled in for the primitive's own.
std::shared_ptr<Geometry> readVertices(const CloudSurface& surface,
                                       const Geometry& from,
                                       const Complex& complex,
                                       std::size_t primitive,
                                       std::span<std::uint32_t> vertex_of) {
    auto to = std::make_shared<Geometry>();
    std::vector<std::uint32_t> sources;
    for (std::uint32_t w = complex.wedge_begin[primitive]; w < complex.wedge_begin[primitive + 1];
         ++w) {
        const std::uint32_t vertex = surface.wedge_vertex[w];
        if (vertex == kNone)
            continue;
        vertex_of[w] = static_cast<std::uint32_t>(sources.size());
        sources.push_back(complex.wedge_source[w]);
        to->positions.emplace_back(surface.positions[vertex]);
    }
    for (const Attribute& attribute : from.attributes)
        to->attributes.push_back(carried(attribute, sources));
    for (const MorphTarget& target : from.morph_targets) {
        to->morph_targets.emplace_back();
        for (const Attribute& attribute : target.attributes)
            to->morph_targets.back().attributes.push_back(carried(attribute, sources));
    }
    return to;
}

} // namespace

std::vector<PrimitiveShape>
shapeOfSurface(const CloudSurface& surface, const Submesh& submesh, const Complex& complex) {
    std::vector<PrimitiveShape> shape(submesh.primitives.size());
    for (std::size_t p = 0; p < shape.size(); ++p) {
        const Geometry& geometry = *submesh.primitives[p].geometry;
        const auto first = surface.wedge_vertex.begin();
        if (submesh.primitives[p].mode == PrimitiveMode::Triangles)
            shape[p].vertices = static_cast<std::uint32_t>(
                std::count_if(first + complex.wedge_begin[p],
                              first + complex.wedge_begin[p + 1],
                              [](std::uint32_t vertex) { return vertex != kNone; }));
        else
            shape[p] = {static_cast<std::uint32_t>(geometry.positions.size()),
                        static_cast<std::uint32_t>(geometry.indices.size())};
    }
    for (const std::uint32_t primitive : surface.primitive)
        shape[primitive].indices += 3;
    return shape;
}

std::vector<GeometryPtr>
readOutSurface(const CloudSurface& surface, const Submesh& submesh, const Complex& complex) {
    std::vector<std::uint32_t> vertex_of(surface.wedge_vertex.size());
    std::vector<std::shared_ptr<Geometry>> made(submesh.primitives.size());
    for (std::size_t p = 0; p < made.size(); ++p)
        if (submesh.primitives[p].mode == PrimitiveMode::Triangles)
            made[p] = readVertices(surface, *submesh.primitives[p].geometry, complex, p, vertex_of);
    for (std::size_t f = 0; f < surface.faces.size(); ++f)
        for (const std::uint32_t wedge : surface.faces[f])
            made[surface.primitive[f]]->indices.push_back(vertex_of[wedge]);
    std::vector<GeometryPtr> primitives;
    for (std::size_t p = 0; p < made.size(); ++p)
        primitives.push_back(made[p] ? made[p] : submesh.primitives[p].geometry);
    return primitives;
}

} // namespace lodestone
