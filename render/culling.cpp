#include "render/culling.h"

#include <algorithm>
#include <cmath>
#include <tbb/parallel_for.h>

namespace lodestone {

namespace {

constexpr double kWorthwhileShare = 0.9; // more than that seen: all are drawn

// Left, right, lower, upper and near; the far one encloses the scene.
std::array<glm::dvec4, 5> frustumPlanes(const OrbitCamera& camera, double aspect) {
    const glm::dmat4 rows = glm::transpose(projectionMatrix(camera, aspect) * viewMatrix(camera));
    std::array<glm::dvec4, 5> planes{rows[3] + rows[0],
                                     rows[3] - rows[0],
                                     rows[3] + rows[1],
                                     rows[3] - rows[1],
                                     rows[3] + rows[2]};
    for (glm::dvec4& plane : planes) {
        const double length = glm::length(glm::dvec3(plane));
        plane = length > 0.0 ? plane / length : glm::dvec4(0.0, 0.0, 0.0, 1.0);
    }
    return planes;
}

// Whether a ball is not wholly outside (reach = radius) or wholly inside (reach = -radius).
bool reaches(const std::array<glm::dvec4, 5>& planes, const glm::dvec3& center, double reach) {
    return std::ranges::none_of(planes, [&](const glm::dvec4& plane) {
        return glm::dot(plane, glm::dvec4(center, 1.0)) < -reach;
    });
}

double largestStretch(const glm::dmat4& transform) { // Frobenius: never less than it
    double squared = 0.0;
    for (int c = 0; c < 3; ++c)
        squared += glm::dot(glm::dvec3(transform[c]), glm::dvec3(transform[c]));
    return std::sqrt(squared);
}

} // namespace

void Culling::prepare(const View::Input& input) {
    const GpuSceneState& scene = input.scene->state();
    if (scene_ == &scene && lod_revision_ == input.lod->revision() && camera_ == input.camera &&
        size_ == input.size)
        return;
    scene_ = &scene;
    lod_revision_ = input.lod->revision();
    camera_ = input.camera;
    size_ = input.size;
    found_.clear();
    planes_ = frustumPlanes(input.camera, input.size.aspect());
    sees_all_ = scene.bounds.empty ||
                reaches(planes_, scene.bounds.center(), -scene.bounds.diagonal() * 0.5);
}

Culling::Found Culling::find(const DrawItem& item, const View::Input& input) const {
    const GpuSceneState& scene = input.scene->state();
    const InstanceRange range = scene.submeshes[item.submesh].range;
    const auto& order = item.instances->order;
    const auto instance = [&](std::uint32_t place) {
        return order ? (*order)[place] : range.begin + place;
    };
    std::vector<std::uint8_t> is_seen(item.kept_instances);
    tbb::parallel_for(std::uint32_t{0}, item.kept_instances, [&](std::uint32_t place) {
        const glm::dmat4& transform = scene.scene->instances[instance(place)].transform;
        const glm::dvec3 center(transform * glm::dvec4(item.geometry->source_center, 1.0));
        const double radius = item.geometry->source_radius * largestStretch(transform);
        is_seen[place] = reaches(planes_, center, radius) ? 1 : 0;
    });
    std::vector<std::uint32_t> seen;
    for (std::uint32_t place = 0; place < item.kept_instances; ++place)
        if (is_seen[place] != 0)
            seen.push_back(instance(place));
    Found found;
    found.all = static_cast<double>(seen.size()) > kWorthwhileShare * item.kept_instances;
    if (found.all || seen.empty())
        return found;
    const std::vector<InstanceRow> rows = packInstances(
        {*scene.scene, range, scene.frame, scene.submeshes[item.submesh].frame}, &seen);
    found.buffer = reserveInstances(nullptr, static_cast<std::uint32_t>(rows.size()));
    const auto bytes = std::as_bytes(std::span(rows));
    copyToBuffer(found.buffer->rows, bytes, 0, bytes.size());
    return found;
}

SeenInstances Culling::seen(std::size_t item_place, const View::Input& input) {
    const DrawItem& item = input.lod->state()->items[item_place];
    const SeenInstances all{item.instances.get(), item.kept_instances};
    if (sees_all_ || input.scene->state().isPosed(item.submesh))
        return all;
    auto known = found_.find(item_place);
    if (known == found_.end())
        known = found_.emplace(item_place, find(item, input)).first;
    if (known->second.all)
        return all;
    const InstanceBuffer* const buffer = known->second.buffer.get();
    return {buffer, buffer ? buffer->count : 0};
}

} // namespace lodestone
