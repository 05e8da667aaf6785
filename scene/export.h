#pragma once
#include "scene/job_context.h"
#include "scene/lod.h"
#include "scene/result.h"

#include <filesystem>
#include <functional>

namespace lodestone {

enum class Instancing : std::uint8_t {
    Auto,   // whichever of the others is smaller, per submesh and for the whole file; an untouched
            // scene is not expanded, nor one whose bytes are packed
    Nodes,  // one node an instance
    Gpu,    // EXT_mesh_gpu_instancing where translation, rotation, scale can express it
    Expand, // no instancing: one mesh a material, vertices in world space
};

enum class Container : std::uint8_t { Glb, Gltf }; // Gltf: .gltf + .bin + images

enum class Compression : std::uint8_t {
    None,     // floats as they are; rotations of instances in 16 bits where that moves nothing
    Quantize, // KHR_mesh_quantization: positions in 16 bits, directions in 8
    Meshopt,  // quantised and packed by EXT_meshopt_compression, instances too
    Draco,    // KHR_draco_mesh_compression
};

struct ExportOptions {
    Instancing instancing = Instancing::Auto;
    Container container = Container::Glb;
    Compression compression = Compression::None;

    bool operator==(const ExportOptions&) const = default;
};

// Whether bytes are packed by an entropy coder.
constexpr bool isPacked(const ExportOptions& options) {
    return options.compression == Compression::Meshopt || options.compression == Compression::Draco;
}

// Whether a size is only known for sure once the LOD is written: packed, or quantised on a grid
// that is wider where survivors of removal have grown, which takes some digits more or fewer.
constexpr bool isEstimated(const ExportOptions& options) {
    return options.compression != Compression::None;
}

struct ExportReport {
    std::uint64_t bytes = 0; // all files written
    std::uint32_t submeshes_as_gpu_instances = 0;
    std::uint32_t submeshes_as_nodes = 0;
    std::vector<std::string> notes; // dropped node names, left-out parts
};

// Predicts without writing what exportScene would write. Prepared once for a scene and options
// (Meshopt and Draco: packs the scene at several levels to learn its rates); bytes() is
// O(primitives) for GPU instancing, O(nodes) otherwise, for each way in which
// Auto may store the scene. Thread-safe.
class ByteModel {
public:
    ByteModel(ScenePtr scene, const ExportOptions& options);
    ~ByteModel();
    ByteModel(ByteModel&&) noexcept;
    ByteModel& operator=(ByteModel&&) noexcept;

    std::uint64_t bytes(const LodShape& shape) const; // within 10 % where isEstimated(options)

    // Fixed rates for orderings per byte; 16 -> 32-bit index jumps left out.
    double bytesPerVertex(std::uint32_t submesh, std::uint32_t primitive) const;
    double bytesPerTriangle(std::uint32_t submesh, std::uint32_t primitive) const;
    double bytesPerInstance(std::uint32_t submesh) const;

private:
    struct Impl;
    std::unique_ptr<const Impl> impl_;
};

// What may stop an export. The default never does.
struct ExportGate {
    std::stop_token stop; // looked at before every piece that is written
    // Asked once, when everything is on the disk and before the first file appears: false:
    // cancelled. Empty: true.
    std::function<bool()> may_replace;
};

// Writes a LOD of the scene. Container follows path's extension (.glb, .gltf) over the option.
// Atomic: temporary file beside it, then rename; an existing file survives any failure.
// What was not simplified comes out as it went in. Same input and options, same bytes.
// Errors: Failed (disk, folder), Cancelled (by the gate; old files stay). Any thread.
Result<ExportReport> exportScene(const Scene& scene,
                                 const Lod& lod,
                                 const std::filesystem::path& path,
                                 const ExportOptions& options,
                                 const ExportGate& gate = {});

} // namespace lodestone
