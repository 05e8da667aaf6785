#include "app/error_map.h"

#include "app/document.h"
#include "scene/vertex_value.h"
#include "simplify/measure/vertex_distance.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace lodestone {

namespace {

constexpr std::size_t kOutliers = 200; // one vertex in so many may lie above the peak

GeometryPtr withValues(const Geometry& geometry, const std::vector<float>& values) {
    auto valued = std::make_shared<Geometry>(geometry);
    Attribute attribute;
    attribute.semantic = kVertexValueSemantic;
    attribute.components = 1;
    attribute.bytes.resize(geometry.positions.size() * sizeof(float));
    if (!values.empty())
        std::memcpy(attribute.bytes.data(),
                    values.data(),
                    std::min(values.size() * sizeof(float), attribute.bytes.size()));
    valued->attributes.push_back(std::move(attribute));
    return valued;
}

double peakOf(std::vector<float> values) {
    if (values.empty())
        return 0.0;
    const auto place = values.end() - 1 - static_cast<std::ptrdiff_t>(values.size() / kOutliers);
    std::ranges::nth_element(values, place);
    return static_cast<double>(*place);
}

} // namespace

Result<ErrorMap> makeErrorMap(const ErrorMapInput& input, const JobContext& job) {
    const Lod full = fullLod(*input.original);
    VertexDistanceField field(input.lod->submeshes.size());
    const bool is_original =
        input.scene == input.original && input.lod->triangles == full.triangles;
    if (!is_original) {
        Result<VertexDistanceField> measured = measureVertexDistances(
            {input.scene.get(), input.lod.get()}, {input.original.get(), &full}, {}, job);
        if (!measured)
            return tl::unexpected<Error>(std::move(measured.error()));
        field = std::move(*measured);
    }
    auto lod = std::make_shared<Lod>(*input.lod);
    std::vector<float> all;
    for (std::size_t s = 0; s < lod->submeshes.size(); ++s)
        for (std::size_t p = 0; p < lod->submeshes[s].primitives.size(); ++p) {
            GeometryPtr& geometry = lod->submeshes[s].primitives[p];
            const bool known = p < field[s].size();
            const std::vector<float> values = known ? field[s][p].max : std::vector<float>();
            geometry = withValues(*geometry, values);
            all.insert(all.end(), values.begin(), values.end());
        }
    return ErrorMap{std::move(lod), peakOf(std::move(all)), 0};
}

double errorMapFull(const Document& document) {
    double peak = 1e-4;
    for (const Lane& lane : document.lanes)
        peak = std::max(peak, lane.status.error_map.peak);
    const double decade = std::pow(10.0, std::floor(std::log10(peak)));
    for (const double step : {1.0, 2.0, 5.0})
        if (peak <= step * decade * 1.0001)
            return step * decade;
    return 10.0 * decade;
}

} // namespace lodestone
