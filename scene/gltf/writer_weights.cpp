#include "scene/gltf/writer_weights.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lodestone {

namespace {

constexpr double kClose = 1e-6; // to 1, for floats

// The greatest number a normalised integer holds; 0 for floats.
double unitsOf(ComponentType type) {
    if (type == ComponentType::UInt8)
        return 255.0;
    return type == ComponentType::UInt16 ? 65535.0 : 0.0;
}

// values add up to sum > 0; afterwards to 1.
void normalize(std::vector<double>& values, double sum, double units) {
    for (double& value : values)
        value /= sum;
    if (units == 0.0)
        return;
    for (double& value : values)
        value = std::round(value * units);
    const double missing = units - std::accumulate(values.begin(), values.end(), 0.0);
    *std::ranges::max_element(values) += missing;
    for (double& value : values)
        value /= units;
}

} // namespace

Attribute normalizedWeights(const Geometry& geometry, const Attribute& weights) {
    std::vector<const Attribute*> sets;
    std::size_t first_value = 0; // of the wanted set among all
    std::size_t value_count = 0;
    for (const Attribute& attribute : geometry.attributes) {
        if (!attribute.semantic.starts_with("WEIGHTS_"))
            continue;
        if (attribute.semantic == weights.semantic)
            first_value = value_count;
        sets.push_back(&attribute);
        value_count += attribute.components;
    }
    Attribute to = weights;
    const double units = unitsOf(weights.type);
    std::vector<double> values(value_count);
    for (std::size_t v = 0; v < geometry.positions.size(); ++v) {
        std::size_t at = 0;
        for (const Attribute* set : sets)
            for (std::size_t c = 0; c < set->components; ++c)
                values[at++] = static_cast<double>(attributeValue(*set, v, c));
        const double sum = std::accumulate(values.begin(), values.end(), 0.0);
        if (!std::isfinite(sum) || !(sum > 0.0) || std::abs(sum - 1.0) < kClose)
            continue;
        normalize(values, sum, units);
        for (std::size_t c = 0; c < weights.components; ++c)
            setAttributeValue(to, v, c, static_cast<float>(values[first_value + c]));
    }
    return to;
}

} // namespace lodestone
