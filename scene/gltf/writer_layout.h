#pragma once
// Where everything of one LOD lies in the exported file: computed from counts alone, so that the
// same layout serves prediction and writing.
#include "scene/gltf/export_plan.h"

namespace lodestone {

// An accessor over vertices or indices.
struct AccessorLayout {
    const StreamPlan* stream = nullptr; // nullptr: indices
    std::uint32_t submesh = 0;          // whose geometry holds the data
    std::uint32_t primitive = 0;
    std::uint32_t view_class = 0;
    std::uint32_t count = 0;
    std::uint64_t offset_bytes = 0; // in its buffer view
};

struct ViewLayout {
    std::uint32_t index = kNone; // number in the file; kNone: empty, not written
    std::uint64_t offset_bytes = 0;
    std::uint64_t size_bytes = 0;
};

struct GroupLayout {
    std::uint32_t rows = 0;                  // kept; 0: not written
    std::uint32_t first_accessor = 0;        // one for each attribute
    bool coarse = false;                     // as GroupPlan::coarse
    std::vector<std::uint64_t> offset_bytes; // [attributes] in the instance view
};

struct Layout {
    std::vector<bool> folds;                // [submeshes] rows instead of nodes
    std::vector<std::uint32_t> node_index;  // [nodes] kNone: not written
    std::vector<bool> draws;                // [nodes] has its mesh
    std::vector<std::uint32_t> mesh_index;  // [meshes] kNone: not written
    std::vector<std::uint32_t> accessor_of; // [streams] number in the file
    std::vector<AccessorLayout> accessors;  // in the file's order, after the carried ones
    std::vector<GroupLayout> groups;        // [groups]
    std::vector<ViewLayout> views;          // [view classes]
    std::uint64_t binary_bytes = 0;         // carried data included, a multiple of 4
    bool uses_rows = false;                 // EXT_mesh_gpu_instancing is written
};

// folds: which submeshes store instances as rows where they can.
Layout layOut(const ExportPlan& plan, const LodShape& shape, std::vector<bool> folds);

// Calls visit(instance) for the kept instances of a submesh in the order of the LOD.
template <class Visit>
void forEachKept(const InstanceRange& range,
                 const LodShape::SubmeshShape& shape,
                 const Visit& visit) {
    const std::uint32_t count = shape.kept_instances;
    if (shape.instance_order)
        for (std::uint32_t k = 0; k < count; ++k)
            visit((*shape.instance_order)[k]);
    else
        for (std::uint32_t k = 0; k < count; ++k)
            visit(range.begin + k);
}

} // namespace lodestone
