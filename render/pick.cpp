#include "render/pick.h"

#include "render/gpu_scene_state.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>
#include <tuple>

namespace lodestone {

namespace {

struct Ball {
    glm::dvec3 center{0.0};
    double radius = 0.0;
};

Ball ballAround(const std::vector<glm::vec3>& positions) {
    Bounds box;
    for (const glm::vec3& position : positions)
        box.add(glm::dvec3(position));
    return {box.center(), box.diagonal() * 0.5};
}

// Which faces can be hit. Front ones are counter-clockwise in the space of the submesh: mirrored
// instances are drawn that way too.
enum class Faces : std::uint8_t { Both, Front };

struct Hit {
    double depth = std::numeric_limits<double>::infinity();
    std::size_t item = 0;
    std::uint32_t instance = 0;

    // Ties go to what is drawn first, so that the order of threads does not matter.
    bool isBefore(const Hit& other) const {
        return std::tie(depth, item, instance) < std::tie(other.depth, other.item, other.instance);
    }
};

bool mayHit(const Ball& ball, const glm::dmat4& transform, const Ray& ray) {
    double squared_stretch = 0.0; // Frobenius: never less than the largest
    for (int c = 0; c < 3; ++c)
        squared_stretch += glm::dot(glm::dvec3(transform[c]), glm::dvec3(transform[c]));
    const glm::dvec3 to_center = glm::dvec3(transform * glm::dvec4(ball.center, 1.0)) - ray.origin;
    const glm::dvec3 across = glm::cross(to_center, ray.direction);
    return glm::dot(across, across) <= squared_stretch * ball.radius * ball.radius * 1.000001;
}

// Depth of the nearest triangle (Moller and Trumbore, 1997); infinity: none. The direction is not
// of unit length: the depth is the world's.
double hitDepth(const Geometry& geometry, const Ray& ray, Faces faces, double smallest_depth) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 2 < geometry.indices.size(); i += 3) {
        const glm::dvec3 corner(geometry.positions[geometry.indices[i]]);
        const glm::dvec3 ab = glm::dvec3(geometry.positions[geometry.indices[i + 1]]) - corner;
        const glm::dvec3 ac = glm::dvec3(geometry.positions[geometry.indices[i + 2]]) - corner;
        const glm::dvec3 across = glm::cross(ray.direction, ac);
        const double determinant = glm::dot(ab, across); // > 0: counter-clockwise
        if (determinant == 0.0 || (faces == Faces::Front && determinant < 0.0))
            continue;
        const glm::dvec3 from = ray.origin - corner;
        const double u = glm::dot(from, across) / determinant;
        const glm::dvec3 turned = glm::cross(from, ab);
        const double v = glm::dot(ray.direction, turned) / determinant;
        if (!(u >= 0.0 && v >= 0.0 && u + v <= 1.0))
            continue;
        const double depth = glm::dot(ac, turned) / determinant;
        if (depth > smallest_depth && depth < nearest)
            nearest = depth;
    }
    return nearest;
}

class Picker {
public:
    Picker(const View::Input& input, const glm::dvec2& point)
        : scene_(input.scene->state()), options_(input.options),
          ray_(cameraRay(input.camera, input.size.aspect(), point)),
          smallest_depth_(input.camera.orthographic ? clipPlanes(input.camera).znear : 0.0) {}

    Hit nearestOf(const DrawItem& item, std::size_t number) const {
        const Ball ball = ballAround(item.geometry->source->positions);
        return tbb::parallel_reduce(
            tbb::blocked_range<std::uint32_t>(0, item.kept_instances, 64),
            Hit(),
            [&](const tbb::blocked_range<std::uint32_t>& range, Hit nearest) {
                for (std::uint32_t at = range.begin(); at < range.end(); ++at) {
                    Hit hit;
                    hit.item = number;
                    hit.instance = instanceAt(item, at);
                    hit.depth = depthOf(item, ball, hit.instance);
                    if (hit.isBefore(nearest))
                        nearest = hit;
                }
                return nearest;
            },
            [](const Hit& a, const Hit& b) { return b.isBefore(a) ? b : a; });
    }

    glm::dvec3 at(double depth) const { return ray_.origin + ray_.direction * depth; }

private:
    std::uint32_t instanceAt(const DrawItem& item, std::uint32_t place) const {
        const auto& order = item.instances->order;
        return order ? (*order)[place] : scene_.submeshes[item.submesh].range.begin + place;
    }

    double depthOf(const DrawItem& item, const Ball& ball, std::uint32_t instance) const {
        if (scene_.isPosed(item.submesh))
            return posedDepthOf(item, instance);
        const glm::dmat4& transform = scene_.scene->instances[instance].transform;
        const double determinant = glm::determinant(glm::dmat3(transform));
        if (!mayHit(ball, transform, ray_) || determinant == 0.0 || !std::isfinite(determinant))
            return std::numeric_limits<double>::infinity();
        const glm::dmat4 local = glm::inverse(transform);
        const Ray ray{glm::dvec3(local * glm::dvec4(ray_.origin, 1.0)),
                      glm::dvec3(local * glm::dvec4(ray_.direction, 0.0))};
        return hitDepth(*item.geometry->source, ray, facesOf(item), smallest_depth_);
    }

    // O(vertices): what a pose deforms has no ball of its own.
    double posedDepthOf(const DrawItem& item, std::uint32_t instance) const {
        const Geometry& source = *item.geometry->source;
        Geometry posed;
        for (const glm::dvec3& position : scene_.posedPositions(source, instance))
            posed.positions.emplace_back(position);
        posed.indices = source.indices;
        const bool is_mirrored = scene_.mirroring(item.submesh) != Mirroring::None;
        return hitDepth(posed, ray_, is_mirrored ? Faces::Both : facesOf(item), smallest_depth_);
    }

    Faces facesOf(const DrawItem& item) const {
        const bool culls = options_.back_faces == BackFaces::PerMaterial &&
                           !scene_.materials[item.material].double_sided;
        return culls ? Faces::Front : Faces::Both;
    }

    const GpuSceneState& scene_;
    const ViewOptions& options_;
    Ray ray_;
    double smallest_depth_ = 0.0;
};

} // namespace

std::optional<Picked> pick(const View::Input& input, const glm::dvec2& point) {
    if (input.scene == nullptr || input.lod == nullptr || !input.lod->valid())
        return std::nullopt;
    const GpuSceneState& scene = input.scene->state();
    const std::vector<DrawItem>& items = input.lod->state()->items;
    const Picker picker(input, point);
    Hit nearest;
    for (std::size_t i = 0; i < items.size(); ++i) {
        const bool hidden = !scene.hidden.empty() && scene.hidden[items[i].submesh];
        if (hidden || items[i].mode != PrimitiveMode::Triangles)
            continue;
        const Hit hit = picker.nearestOf(items[i], i);
        if (hit.isBefore(nearest))
            nearest = hit;
    }
    if (!std::isfinite(nearest.depth))
        return std::nullopt;
    return Picked{
        items[nearest.item].submesh, nearest.instance, picker.at(nearest.depth), nearest.depth};
}

} // namespace lodestone
