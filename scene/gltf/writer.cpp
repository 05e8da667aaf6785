#include "scene/gltf/writer.h"

#include "scene/gltf/writer_geometry.h"
#include "scene/gltf/writer_json.h"
#include "scene/gltf/writer_uri.h"

#include <algorithm>
#include <tbb/parallel_for.h>

namespace lodestone {

namespace {

constexpr std::uint64_t kGlbHeaderBytes = 12;
constexpr std::uint64_t kGlbChunkHeaderBytes = 8;
// Characters that the name of the .bin has in the JSON, filled up with spaces after it.
constexpr std::size_t kBufferNameWidth = 64;
// Below this estimated gain of rows over nodes, both are counted exactly.
constexpr double kCloseCallBytes = 400.0;

std::string bufferUriText(const std::string& buffer_file) {
    const std::string name = percentEncoded(buffer_file);
    return ",\"uri\":\"" + name + "\"" +
           std::string(kBufferNameWidth - std::min(kBufferNameWidth, name.size()), ' ');
}

std::string uriTextFor(const ExportPlan& plan, const std::string& buffer_file) {
    return plan.options.container == Container::Glb ? std::string() : bufferUriText(buffer_file);
}

} // namespace

std::string bufferFileName(const std::filesystem::path& gltf_path) {
    std::string stem = gltf_path.stem().string();
    constexpr std::string_view kExtension = ".bin";
    if (percentEncoded(stem).size() + kExtension.size() > kBufferNameWidth) {
        const std::string mark = std::to_string(std::hash<std::string>{}(stem));
        while (percentEncoded(stem + mark).size() + kExtension.size() > kBufferNameWidth)
            stem.pop_back();
        stem += mark;
    }
    return stem + std::string(kExtension);
}

Layout chooseLayout(const ExportPlan& plan, const LodShape& shape) {
    std::vector<bool> folds(plan.submeshes.size(), false);
    double gain_bytes = 0.0;
    bool any = false;
    for (std::size_t s = 0; s < folds.size(); ++s) {
        const SubmeshPlan& submesh = plan.submeshes[s];
        const std::uint32_t kept = shape.submeshes[s].kept_instances;
        folds[s] = kept > 0 && kept >= submesh.fold_from;
        any |= folds[s];
        if (folds[s])
            gain_bytes +=
                (submesh.node_bytes - submesh.row_bytes) * kept - submesh.fold_fixed_bytes;
    }
    Layout layout = layOut(plan, shape, folds);
    if (plan.options.instancing != Instancing::Auto || !any || gain_bytes > kCloseCallBytes)
        return layout;
    Layout nodes = layOut(plan, shape, std::vector<bool>(folds.size(), false));
    const bool nodes_are_smaller = exportedBytes(plan, nodes) < exportedBytes(plan, layout);
    return nodes_are_smaller ? nodes : layout;
}

std::uint64_t exportedBytes(const ExportPlan& plan, const Layout& layout) {
    CountingSink sink;
    JsonEmitter<CountingSink>(plan, layout, {}, sink).emit(uriTextFor(plan, ""));
    std::uint64_t bytes = sink.sizeBytes();
    if (plan.options.container == Container::Glb) {
        bytes = (bytes + 3) & ~std::uint64_t{3};
        bytes += kGlbHeaderBytes + kGlbChunkHeaderBytes;
        return bytes + (layout.binary_bytes > 0 ? kGlbChunkHeaderBytes + layout.binary_bytes : 0);
    }
    for (const ImageFile& image : plan.image_files)
        bytes += image.bytes->size();
    return bytes + layout.binary_bytes;
}

Result<std::string> exportedJson(const ExportPlan& plan,
                                 const Layout& layout,
                                 const Lod& lod,
                                 const std::string& buffer_file) {
    if (Result<void> checked = checkLod(plan, lod); !checked)
        return tl::unexpected(checked.error());
    std::vector<AccessorBounds> bounds(layout.accessors.size());
    tbb::parallel_for(std::size_t{0}, bounds.size(), [&](std::size_t a) {
        bounds[a] = boundsOf(plan, layout.accessors[a], lod);
    });
    StringSink sink;
    JsonEmitter<StringSink>(plan, layout, bounds, sink).emit(uriTextFor(plan, buffer_file));
    return sink.take();
}

bool writeBinary(const ExportPlan& plan,
                 const Layout& layout,
                 const Lod& lod,
                 const std::function<bool(std::span<const std::byte>)>& write) {
    std::vector<std::byte> carried;
    plan.carried.appendTo(carried);
    if (!write(carried))
        return false;
    for (std::uint32_t view = 0; view < layout.views.size(); ++view) {
        if (view == kInstanceClass) {
            for (std::uint32_t g = 0; g < plan.groups.size(); ++g)
                for (const std::vector<std::byte>& bytes : rowBytes(plan, layout, lod, g))
                    if (!write(bytes))
                        return false;
            continue;
        }
        for (const AccessorLayout& accessor : layout.accessors)
            if (accessor.view_class == view && !write(accessorBytes(plan, accessor, lod)))
                return false;
    }
    return true;
}

} // namespace lodestone
