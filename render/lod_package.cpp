#include "render/lod_package_parts.h"

#include <algorithm>
#include <tbb/parallel_for.h>

namespace lodestone {

LodPackage::LodPackage() : parts_(std::make_unique<Parts>()) {}

LodPackage::~LodPackage() = default;
LodPackage::LodPackage(LodPackage&&) noexcept = default;
LodPackage& LodPackage::operator=(LodPackage&&) noexcept = default;

std::uint64_t LodPackage::work() const {
    return parts_->work;
}

void LodPackage::pack() {
    tbb::parallel_for(std::size_t{0}, parts_->geometries.size(), [this](std::size_t at) {
        Parts::GeometryPart& part = parts_->geometries[at];
        part.packed = packGeometry(part.source, part.frame, part.mode);
    });
    for (Parts::InstancePart& part : parts_->instances)
        part.rows = packInstances({*parts_->scene, part.range, parts_->scene_frame, part.frame},
                                  part.order.get());
}

namespace {

// Vertices first, then indices, then morph targets. Returns the number of bytes copied.
std::size_t copyGeometry(const PackedGeometry& packed,
                         const GpuGeometry& gpu,
                         std::size_t begin,
                         std::size_t most) {
    std::size_t count = copyToBuffer(gpu.vertices, packed.vertices, begin, most);
    if (begin + count >= packed.vertices.size())
        count += copyToBuffer(
            gpu.indices, packed.indices, begin + count - packed.vertices.size(), most - count);
    const std::size_t before_morphs = packed.vertices.size() + packed.indices.size();
    if (begin + count >= before_morphs)
        count +=
            copyToBuffer(gpu.morphs, packed.morphs, begin + count - before_morphs, most - count);
    return count;
}

} // namespace

std::uint64_t LodPackage::copy(std::uint64_t most_bytes) {
    Parts& parts = *parts_;
    std::uint64_t copied_now = 0;
    while (!copied() && copied_now < most_bytes) {
        const std::size_t most = most_bytes - copied_now;
        std::size_t part_bytes = 0;
        std::size_t count = 0;
        if (parts.part < parts.geometries.size()) {
            Parts::GeometryPart& part = parts.geometries[parts.part];
            if (!part.gpu)
                part.gpu = reserveGeometry(part.packed);
            part_bytes = part.gpu->bytes;
            count = copyGeometry(part.packed, *part.gpu, parts.copied_bytes, most);
            if (parts.copied_bytes + count >= part_bytes)
                part.packed = PackedGeometry();
        } else {
            Parts::InstancePart& part = parts.instances[parts.part - parts.geometries.size()];
            if (!part.gpu)
                part.gpu =
                    reserveInstances(part.order, static_cast<std::uint32_t>(part.rows.size()));
            part_bytes = part.gpu->bytes;
            count = copyToBuffer(
                part.gpu->rows, std::as_bytes(std::span(part.rows)), parts.copied_bytes, most);
            if (parts.copied_bytes + count >= part_bytes)
                part.rows = {};
        }
        copied_now += count;
        parts.copied_bytes += count;
        if (parts.copied_bytes >= part_bytes) {
            ++parts.part;
            parts.copied_bytes = 0;
        }
    }
    return copied_now;
}

bool LodPackage::copied() const {
    return parts_->part >= parts_->geometries.size() + parts_->instances.size();
}

} // namespace lodestone
