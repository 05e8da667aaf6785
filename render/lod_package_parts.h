#pragma once
// Inside render/ only: what a LodPackage holds.
#include "render/gpu_geometry.h"
#include "render/lod_package.h"

#include <optional>

namespace lodestone {

struct LodPackage::Parts {
    struct GeometryPart {
        GeometryPtr source;
        std::uint32_t submesh = 0;
        PrimitiveMode mode = PrimitiveMode::Triangles;
        LocalFrame frame;
        PackedGeometry packed;            // by pack(), emptied once copied
        std::shared_ptr<GpuGeometry> gpu; // by copy()
    };

    struct InstancePart {
        std::shared_ptr<const std::vector<std::uint32_t>> order; // null: the scene's order
        std::uint32_t submesh = 0;
        InstanceRange range;
        LocalFrame frame;
        std::vector<InstanceRow> rows;       // by pack(), emptied once copied
        std::shared_ptr<InstanceBuffer> gpu; // by copy()
    };

    ScenePtr scene;
    SceneFrame scene_frame;
    std::vector<GeometryPart> geometries;
    std::vector<InstancePart> instances;
    std::uint64_t work = 0;
    // Where copying goes on.
    std::size_t part = 0;         // in geometries, then in instances
    std::size_t copied_bytes = 0; // of that part
};

} // namespace lodestone
