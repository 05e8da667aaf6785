#pragma once
// What a LOD will weigh once it is packed, learned from a few packed levels of its scene.
#include "scene/gltf/packed_document.h"
#include "scene/gltf/writer.h"

#include <array>

namespace lodestone {

// Bytes of an export by part.
struct ExportBytes {
    enum Part : std::uint8_t { Geometry, Rows, Text };

    std::array<double, 3> parts{};
    double fixed = 0.0; // the same packed or not: carried data, image files, headers
};

ExportBytes exportBytes(const ExportPlan& plan, const Layout& layout);
// text_bytes: of the packed document as written. unpacked: of the same LOD.
ExportBytes
packedBytes(const PackedDocument& packed, std::size_t text_bytes, const ExportBytes& unpacked);

// Ratios of packed to unpacked bytes, interpolated over the logarithm of the size: coarser meshes
// and sparser instances differ more from their neighbours and pack less well.
class PackedSizes {
public:
    void learn(const ExportBytes& unpacked, const ExportBytes& packed);

    double estimate(const ExportBytes& unpacked) const;
    // Of the largest that was learned.
    double ratio(ExportBytes::Part part) const;

private:
    struct Sample {
        double unpacked = 0.0;
        double ratio = 1.0;
    };

    double ratioAt(ExportBytes::Part part, double unpacked) const;

    std::array<std::vector<Sample>, 3> samples_; // [parts] falling sizes
};

// About that share of every submesh's triangles and instances, to learn from: not a LOD to look at.
// share in (0, 1]. Deterministic.
Lod sampleLod(const Scene& scene, double share);

} // namespace lodestone
