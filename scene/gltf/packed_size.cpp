#include "scene/gltf/packed_size.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <meshoptimizer.h>
#include <tbb/parallel_for.h>

namespace lodestone {

namespace {

constexpr std::uint64_t kGlbHeaders = 12 + 8 + 8;

// The vertices that the indices use, in the order of the geometry.
GeometryPtr compacted(const Geometry& from, std::vector<std::uint32_t> indices) {
    std::vector<std::uint32_t> place(from.positions.size(), kNone);
    for (const std::uint32_t index : indices)
        place[index] = 0;
    auto to = std::make_shared<Geometry>();
    std::vector<std::uint32_t> kept;
    for (std::uint32_t v = 0; v < place.size(); ++v)
        if (place[v] != kNone) {
            place[v] = static_cast<std::uint32_t>(kept.size());
            kept.push_back(v);
        }
    const auto gather = [&](const Attribute& attribute) {
        Attribute some = attribute;
        const std::size_t stride = attribute.stride();
        some.bytes.resize(kept.size() * stride);
        for (std::size_t v = 0; v < kept.size(); ++v)
            std::memcpy(
                some.bytes.data() + v * stride, attribute.bytes.data() + kept[v] * stride, stride);
        return some;
    };
    for (const std::uint32_t v : kept)
        to->positions.push_back(from.positions[v]);
    for (const Attribute& attribute : from.attributes)
        to->attributes.push_back(gather(attribute));
    for (const MorphTarget& target : from.morph_targets) {
        to->morph_targets.emplace_back();
        for (const Attribute& attribute : target.attributes)
            to->morph_targets.back().attributes.push_back(gather(attribute));
    }
    for (std::uint32_t& index : indices)
        index = place[index];
    to->indices = std::move(indices);
    return to;
}

GeometryPtr sampled(const Geometry& from, double share) {
    const auto wanted = static_cast<std::size_t>(static_cast<double>(from.triangleCount()) * share);
    const std::size_t target = std::max<std::size_t>(wanted, 1) * 3;
    constexpr float kAnyError = 1e6f;
    constexpr double kStuck = 1.5; // x the target: seams hold it up
    const float* const positions = &from.positions[0].x;
    std::vector<std::uint32_t> indices(from.indices.size());
    std::size_t count = meshopt_simplify(indices.data(),
                                         from.indices.data(),
                                         from.indices.size(),
                                         positions,
                                         from.positions.size(),
                                         sizeof(glm::vec3),
                                         target,
                                         kAnyError,
                                         0,
                                         nullptr);
    if (static_cast<double>(count) > kStuck * static_cast<double>(target))
        count = meshopt_simplifySloppy(indices.data(),
                                       from.indices.data(),
                                       from.indices.size(),
                                       positions,
                                       from.positions.size(),
                                       sizeof(glm::vec3),
                                       target,
                                       kAnyError,
                                       nullptr);
    indices.resize(count);
    return compacted(from, std::move(indices));
}

} // namespace

ExportBytes exportBytes(const ExportPlan& plan, const Layout& layout) {
    ExportBytes bytes;
    for (std::uint32_t view = 0; view < layout.views.size(); ++view)
        bytes.parts[view == kInstanceClass ? ExportBytes::Rows : ExportBytes::Geometry] +=
            static_cast<double>(layout.views[view].size_bytes);
    std::uint64_t fixed = plan.carried.sizeBytes();
    if (plan.options.container == Container::Glb)
        fixed += kGlbHeaders;
    for (const ImageFile& image : plan.image_files)
        fixed += image.bytes->size();
    bytes.fixed = static_cast<double>(fixed);
    bytes.parts[ExportBytes::Text] = static_cast<double>(exportedBytes(plan, layout)) -
                                     bytes.fixed - bytes.parts[ExportBytes::Rows] -
                                     bytes.parts[ExportBytes::Geometry];
    return bytes;
}

ExportBytes
packedBytes(const PackedDocument& packed, std::size_t text_bytes, const ExportBytes& unpacked) {
    ExportBytes bytes;
    bytes.fixed = unpacked.fixed;
    bytes.parts[ExportBytes::Text] = static_cast<double>(text_bytes);
    bytes.parts[ExportBytes::Rows] = static_cast<double>(packed.row_bytes);
    bytes.parts[ExportBytes::Geometry] =
        static_cast<double>(packed.binary.size() - packed.first_byte - packed.row_bytes);
    return bytes;
}

void PackedSizes::learn(const ExportBytes& unpacked, const ExportBytes& packed) {
    for (std::size_t part = 0; part < samples_.size(); ++part)
        if (const double size = unpacked.parts[part]; size > 0.0)
            samples_[part].push_back({size, packed.parts[part] / size});
    for (std::vector<Sample>& samples : samples_)
        std::ranges::stable_sort(samples, std::ranges::greater{}, &Sample::unpacked);
}

double PackedSizes::ratio(ExportBytes::Part part) const {
    return samples_[part].empty() ? 1.0 : samples_[part].front().ratio;
}

double PackedSizes::ratioAt(ExportBytes::Part part, double unpacked) const {
    const std::vector<Sample>& samples = samples_[part];
    if (samples.empty() || unpacked >= samples.front().unpacked)
        return ratio(part);
    for (std::size_t i = 1; i < samples.size(); ++i) {
        const Sample& more = samples[i - 1];
        const Sample& less = samples[i];
        if (unpacked < less.unpacked || more.unpacked == less.unpacked)
            continue;
        const double along =
            std::log(unpacked / less.unpacked) / std::log(more.unpacked / less.unpacked);
        return less.ratio + along * (more.ratio - less.ratio);
    }
    return samples.back().ratio;
}

double PackedSizes::estimate(const ExportBytes& unpacked) const {
    double bytes = unpacked.fixed;
    for (const auto part : {ExportBytes::Geometry, ExportBytes::Rows, ExportBytes::Text})
        bytes += unpacked.parts[part] * ratioAt(part, unpacked.parts[part]);
    return bytes;
}

Lod sampleLod(const Scene& scene, double share) {
    Lod lod = fullLod(scene);
    if (share >= 1.0)
        return lod;
    const std::vector<InstanceRange> ranges = instanceRanges(scene);
    tbb::parallel_for(std::size_t{0}, lod.submeshes.size(), [&](std::size_t s) {
        LodSubmesh& submesh = lod.submeshes[s];
        for (std::size_t p = 0; p < submesh.primitives.size(); ++p)
            if (scene.submeshes[s].primitives[p].mode == PrimitiveMode::Triangles &&
                !submesh.primitives[p]->indices.empty())
                submesh.primitives[p] = sampled(*submesh.primitives[p], share);
        const std::uint32_t count = ranges[s].size();
        submesh.kept_instances = std::max(
            std::min(count, 1U), static_cast<std::uint32_t>(static_cast<double>(count) * share));
        auto order = std::make_shared<std::vector<std::uint32_t>>();
        for (std::uint32_t k = 0; k < submesh.kept_instances; ++k)
            order->push_back(ranges[s].begin + static_cast<std::uint32_t>(std::uint64_t{k} * count /
                                                                          submesh.kept_instances));
        submesh.instance_order = std::move(order);
    });
    return lod;
}

} // namespace lodestone
