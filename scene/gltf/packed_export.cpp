#include "scene/gltf/packed_export.h"

#include "scene/gltf/draco_writer.h"
#include "scene/gltf/meshopt_writer.h"
#include "scene/gltf/vertex_order.h"
#include "scene/gltf/writer_geometry.h"

namespace lodestone {

using nlohmann::json;

Result<PackedDocument> packedExport(const ExportPlan& plan,
                                    const Layout& layout,
                                    const Lod& lod,
                                    const std::string& buffer_file) {
    const bool meshopt = plan.options.compression == Compression::Meshopt;
    if (Result<void> checked = checkLod(plan, lod); !checked)
        return tl::unexpected(checked.error());
    const Lod ordered = meshopt ? inFetchOrder(plan, lod, shapeOf(plan.scene, lod)) : lod;
    Result<std::string> text = exportedJson(plan, layout, ordered, buffer_file);
    if (!text)
        return tl::unexpected(text.error());
    PackedDocument document;
    document.json = json::parse(*text);
    document.first_view = plan.carried.viewCount();
    document.first_byte = plan.carried.sizeBytes();
    document.diagonal = plan.diagonal;
    document.binary.reserve(layout.binary_bytes);
    writeBinary(plan, layout, ordered, [&](std::span<const std::byte> bytes) {
        document.binary.insert(document.binary.end(), bytes.begin(), bytes.end());
        return true;
    });
    if (meshopt)
        packMeshopt(document);
    else
        packDraco(document);
    return document;
}

} // namespace lodestone
