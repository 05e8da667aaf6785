#include "simplify/geomorph.h"

#include <algorithm>
#include <cstring>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace lodestone {

namespace {

constexpr std::size_t kGrain = 16'384; // vertices a task

template <class Body>
void forBlocks(std::size_t count, const Body& body) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, kGrain),
                      [&](const auto& range) { body(range.begin(), range.end()); });
}

void slide(Attribute& attribute, const Attribute& end, float share) {
    const std::size_t count = attribute.bytes.size() / sizeof(float);
    forBlocks(count, [&](std::size_t begin, std::size_t behind) {
        for (std::size_t at = begin; at < behind; ++at) {
            std::byte* const place = attribute.bytes.data() + at * sizeof(float);
            float from = 0.0f;
            float to = 0.0f;
            std::memcpy(&from, place, sizeof from);
            std::memcpy(&to, end.bytes.data() + at * sizeof(float), sizeof to);
            from += (to - from) * share;
            std::memcpy(place, &from, sizeof from);
        }
    });
}

GeometryPtr slid(const Geometry& fine, const Geometry& end, float share) {
    auto geometry = std::make_shared<Geometry>(fine);
    forBlocks(geometry->positions.size(), [&](std::size_t begin, std::size_t behind) {
        for (std::size_t at = begin; at < behind; ++at)
            geometry->positions[at] += (end.positions[at] - fine.positions[at]) * share;
    });
    for (std::size_t at = 0; at < geometry->attributes.size(); ++at)
        if (geometry->attributes[at].type == ComponentType::Float32)
            slide(geometry->attributes[at], end.attributes[at], share);
    return geometry;
}

} // namespace

Lod slid(const Geomorph& geomorph, double share) {
    Lod lod = geomorph.fine;
    const auto way = static_cast<float>(std::clamp(share, 0.0, 1.0));
    if (way <= 0.0f)
        return lod;
    tbb::parallel_for(std::size_t{0}, geomorph.ends.size(), [&](std::size_t s) {
        const std::vector<GeometryPtr>& ends = geomorph.ends[s];
        std::vector<GeometryPtr>& primitives = lod.submeshes[s].primitives;
        for (std::size_t p = 0; p < ends.size(); ++p)
            if (ends[p] != primitives[p])
                primitives[p] = slid(*primitives[p], *ends[p], way);
    });
    return lod;
}

} // namespace lodestone
