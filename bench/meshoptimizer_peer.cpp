#include "bench/meshoptimizer_peer.h"

#include <meshoptimizer.h>

namespace lodestone::bench {

std::string meshoptimizerName() {
    return "meshoptimizer " + std::to_string(MESHOPTIMIZER_VERSION / 1000) + "." +
           std::to_string(MESHOPTIMIZER_VERSION % 1000 / 10);
}

std::vector<std::uint32_t> meshoptimizerSimplify(const Geometry& geometry, double ratio) {
    constexpr float kNoErrorLimit = 1e10F;
    const auto target_triangles =
        static_cast<std::size_t>(static_cast<double>(geometry.triangleCount()) * ratio);
    std::vector<std::uint32_t> indices(geometry.indices.size());
    indices.resize(meshopt_simplify(indices.data(),
                                    geometry.indices.data(),
                                    geometry.indices.size(),
                                    &geometry.positions.front().x,
                                    geometry.positions.size(),
                                    sizeof(glm::vec3),
                                    3 * target_triangles,
                                    kNoErrorLimit,
                                    0,
                                    nullptr));
    return indices;
}

Geometry weldPositions(const Geometry& geometry) {
    std::vector<std::uint32_t> remap(geometry.positions.size());
    const std::size_t distinct = meshopt_generateVertexRemap(remap.data(),
                                                             nullptr,
                                                             geometry.positions.size(),
                                                             geometry.positions.data(),
                                                             geometry.positions.size(),
                                                             sizeof(glm::vec3));
    Geometry welded;
    welded.positions.resize(distinct);
    for (std::size_t vertex = 0; vertex < remap.size(); ++vertex)
        welded.positions[remap[vertex]] = geometry.positions[vertex];
    for (const std::uint32_t vertex : geometry.indices)
        welded.indices.push_back(remap[vertex]);
    return welded;
}

namespace {

GeometryPtr withIndices(const Geometry& vertices, std::vector<std::uint32_t> indices) {
    auto made = std::make_shared<Geometry>();
    made->positions = vertices.positions;
    made->indices = std::move(indices);
    return made;
}

} // namespace

Lod simplifyEachMesh(const Scene& scene, double ratio, Welding welding) {
    Lod lod = fullLod(scene);
    lod.triangles = 0;
    lod.unique_triangles = 0;
    const std::vector<InstanceRange> ranges = instanceRanges(scene);
    for (std::size_t s = 0; s < ranges.size(); ++s) {
        const std::vector<Primitive>& primitives = scene.submeshes[s].primitives;
        for (std::size_t p = 0; p < primitives.size(); ++p) {
            if (primitives[p].mode != PrimitiveMode::Triangles || ranges[s].size() == 0)
                continue;
            const Geometry& stored = *primitives[p].geometry;
            const Geometry welded =
                welding == Welding::Positions ? weldPositions(stored) : Geometry();
            const Geometry& input = welding == Welding::Positions ? welded : stored;
            GeometryPtr& simplified = lod.submeshes[s].primitives[p];
            simplified = withIndices(input, meshoptimizerSimplify(input, ratio));
            lod.unique_triangles += simplified->triangleCount();
            lod.triangles += simplified->triangleCount() * ranges[s].size();
        }
    }
    return lod;
}

Lod lodOfIndices(const Scene& scene, const Geometry& vertices, std::vector<std::uint32_t> indices) {
    Lod lod = fullLod(scene);
    lod.triangles = lod.unique_triangles = indices.size() / 3;
    lod.submeshes.front().primitives.front() = withIndices(vertices, std::move(indices));
    return lod;
}

} // namespace lodestone::bench
