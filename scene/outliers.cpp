#include "scene/outliers.h"

namespace lodestone {

namespace {

bool contains(const Bounds& bounds, const glm::dvec3& point) {
    return glm::all(glm::greaterThanEqual(point, bounds.min)) &&
           glm::all(glm::lessThanEqual(point, bounds.max));
}

struct Outliers {
    std::uint64_t count = 0;
    std::string first;
};

Outliers findOutliers(const Scene& scene, const Bounds& bulk) {
    Outliers outliers;
    for (const Instance& instance : scene.instances) {
        const Submesh& submesh = scene.submeshes[instance.submesh];
        for (std::size_t p = 0; p < submesh.primitives.size(); ++p) {
            const std::vector<glm::vec3>& positions = submesh.primitives[p].geometry->positions;
            for (std::size_t v = 0; v < positions.size(); ++v) {
                const glm::dvec3 world(instance.transform *
                                       glm::dvec4(glm::dvec3(positions[v]), 1.0));
                if (contains(bulk, world))
                    continue;
                if (outliers.count++ == 0)
                    outliers.first = "mesh " + std::to_string(instance.submesh) + " '" +
                                     submesh.name + "' primitive " + std::to_string(p) +
                                     " vertex " + std::to_string(v);
            }
        }
    }
    return outliers;
}

} // namespace

void noteOutliers(Scene& scene) {
    const Bounds bulk = robustWorldBounds(scene);
    const Bounds all = worldBounds(scene);
    if (bulk.empty || (bulk.min == all.min && bulk.max == all.max))
        return;
    const Outliers outliers = findOutliers(scene, bulk);
    scene.notes.push_back(std::to_string(outliers.count) +
                          (outliers.count == 1 ? " vertex lies" : " vertices lie") +
                          " absurdly far from the rest (first: " + outliers.first +
                          "); framing and error percentages leave them out");
}

} // namespace lodestone
