#pragma once
// Everything of an export that is the same for every LOD of a scene: constant JSON text, the
// accessors each primitive needs, and the ways its instances can be stored. Made once, read by any
// number of threads.
#include "scene/export.h"
#include "scene/gltf/json_sink.h"
#include "scene/gltf/quantization.h"
#include "scene/gltf/writer_carried.h"

namespace lodestone {

constexpr std::uint32_t kIndex32Class = 0; // view classes: one buffer view holds all of a class
constexpr std::uint32_t kIndex16Class = 1;
constexpr std::uint32_t kInstanceClass = 2;
constexpr std::uint32_t kFirstStrideClass = 3; // vertex attributes of one stride

// One accessor of a primitive.
struct StreamPlan {
    std::string key;              // "POSITION":
    std::string format;           // "componentType":5126,"type":"VEC3"
    std::uint32_t attribute = 0;  // in the geometry's or the target's attributes; kNone: positions
    std::uint32_t target = kNone; // morph target it belongs to
    StoredType stored;
    std::uint32_t view_class = 0;
    std::uint32_t content = 0; // streams of equal content hold equal bytes in the unchanged scene
    std::uint32_t component_count = 0;
    std::uint32_t bounds_width = 0; // characters of a number in min and max; 0: has none
};

struct PrimitivePlan {
    std::vector<StreamPlan> streams; // positions, attributes, then those of morph targets
    std::uint32_t index_content = 0;
    std::uint32_t first_stream = 0; // flat number of streams[0]; the indices come after the last
    std::string rest;               // other members, a comma before each
    PrimitiveShape full;            // counts in the unchanged scene
    bool indexed = true;            // draws nothing without indices
};

struct MeshPlan {
    std::uint32_t submesh = kNone;         // kNone: passed on whole
    std::string whole;                     // JSON of a mesh that is passed on whole
    Fragment rest;                         // other members, comma separated
    std::vector<PrimitivePlan> primitives; // [submesh.primitives]
    bool wanted = false;                   // stays even if no instance is kept
};

// A node of the export, kept or not according to the LOD.
struct NodePlan {
    Fragment body;         // members but children, extensions and what needs a mesh
    Fragment extensions;   // members of "extensions" but EXT_mesh_gpu_instancing
    std::string with_mesh; // members that only go with a mesh: skin, weights
    std::uint32_t parent = kNone;
    std::uint32_t mesh = kNone;  // in ExportPlan::meshes
    std::uint32_t group = kNone; // in ExportPlan::groups
    bool always = false;         // has a duty of its own, or was empty in the file
    bool always_draws = false;   // outside of the drawn scene: not part of any LOD
};

// One accessor of an EXT_mesh_gpu_instancing node.
struct GroupAttribute {
    std::string key; // "TRANSLATION":
    std::string format;
    std::size_t row_bytes = 0;
    std::vector<std::byte> bytes; // [rows * row_bytes]
};

// Instances of one submesh that can be rows of one EXT_mesh_gpu_instancing node.
struct GroupPlan {
    std::uint32_t submesh = 0;
    std::uint32_t node = 0; // in ExportPlan::nodes
    std::uint32_t rows = 0;
    bool folded = false; // made of nodes; otherwise the file's own
    std::vector<GroupAttribute> attributes;
    // What is stored of these in LODs that keep a third of the submesh's triangles or fewer:
    // rotations in 8 bits, as by coarseAttributes(). Empty where a point of the submesh as it was
    // would move by more than 2^-10 of the diagonal.
    std::vector<GroupAttribute> coarse;

    // How attributes[a] is stored.
    const GroupAttribute& stored(std::size_t a, bool coarsely) const {
        if (coarsely)
            for (const GroupAttribute& attribute : coarse)
                if (attribute.key == attributes[a].key)
                    return attribute;
        return attributes[a];
    }
};

struct InstancePlan {
    std::uint32_t node = kNone;  // drawn by this node where it is not a row
    std::uint32_t group = kNone; // may be a row of this group
    std::uint32_t row = 0;
    bool named = false; // its node has a name that folding drops
};

struct SubmeshPlan {
    std::uint32_t mesh = 0;
    InstanceRange range;
    std::uint32_t sole_group = kNone; // the group that holds every instance, if there is one
    std::uint32_t fold_from = kNone;  // kept instances from which rows are smaller than nodes
    double fold_fixed_bytes = 0.0;    // of its groups, whatever the number of rows
    double row_bytes = 0.0;           // of one row
    double node_bytes = 0.0;          // of one node, on average
};

struct ScenePlan {
    Fragment rest;                    // other members, comma separated
    std::vector<std::uint32_t> nodes; // roots
};

// An image that becomes a file beside a .gltf.
struct ImageFile {
    std::filesystem::path path; // relative to the .gltf, never outside its folder
    std::shared_ptr<const std::vector<std::byte>> bytes;
};

struct ExportPlan {
    // grids: as made by planGrids().
    ExportPlan(const Scene& scene, const ExportOptions& options, std::vector<PositionGrid> grids);

    const Scene& scene;
    ExportOptions options;
    std::vector<PositionGrid> grids;     // [scene.submeshes]
    double diagonal = 0.0;               // of the scene, as by boxDiagonal()
    std::vector<std::uint32_t> drawn_by; // [source nodes] in nodes: what draws the node's mesh
    CarriedData carried;
    Fragment head; // asset, materials, animations, ...: members, comma separated
    std::vector<std::string> extensions_used;
    std::vector<std::string> extensions_required;
    std::vector<MeshPlan> meshes;
    std::vector<SubmeshPlan> submeshes; // [scene.submeshes]
    std::vector<NodePlan> nodes;
    std::vector<std::uint32_t> first_child; // [nodes + 1] into children
    std::vector<std::uint32_t> children;
    std::vector<std::uint32_t> bottom_up; // nodes, children before parents
    std::vector<std::uint32_t> parents;   // [nodes] as in NodePlan, close together
    std::vector<std::uint32_t> always;    // nodes with that mark
    std::vector<std::uint32_t> always_draws;
    std::vector<GroupPlan> groups;
    std::vector<InstancePlan> instances; // [scene.instances]
    std::vector<ScenePlan> scenes;
    std::vector<std::uint32_t> strides; // bytes of class kFirstStrideClass + i
    std::uint32_t stream_count = 0;
    std::uint32_t content_count = 0;
    std::vector<ImageFile> image_files; // Container::Gltf only
    std::vector<std::string> notes;
};

} // namespace lodestone
