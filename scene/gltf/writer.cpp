#include "scene/gltf/writer.h"

#include "scene/gltf/writer_geometry.h"
#include "scene/gltf/writer_json.h"
#include "scene/gltf/writer_uri.h"

#include <algorithm>
#include <cmath>
#include <tbb/parallel_for.h>

namespace lodestone {

namespace {

constexpr std::uint64_t kGlbHeaderBytes = 12;
constexpr std::uint64_t kGlbChunkHeaderBytes = 8;
// Characters that the name of the .bin has in the JSON, filled up with spaces after it.
constexpr std::size_t kBufferNameWidth = 64;
// Where the estimated gain of rows over nodes is less, both are counted exactly: of one submesh,
constexpr double kCloseCallBytes = 60.0;
constexpr std::size_t kMostCloseCalls = 3;
// and of all, as the extension is named twice.
constexpr double kExtensionBytes = 400.0;

std::string bufferUriText(const std::string& buffer_file) {
    const std::string name = percentEncoded(buffer_file);
    return ",\"uri\":\"" + name + "\"" +
           std::string(kBufferNameWidth - std::min(kBufferNameWidth, name.size()), ' ');
}

std::string uriTextFor(const ExportPlan& plan, const std::string& buffer_file) {
    return plan.options.container == Container::Glb ? std::string() : bufferUriText(buffer_file);
}

// FNV-1a: the same on every machine.
std::uint64_t stableHash(std::string_view text) {
    std::uint64_t hash = 0xcbf29ce484222325ULL;
    for (const char c : text)
        hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
    return hash;
}

// A submesh that may be smaller either way.
struct CloseCall {
    double distance_bytes = 0.0; // from the estimated break-even
    std::uint32_t submesh = 0;
};

struct Candidate {
    std::vector<bool> folds;
    Layout layout;
    std::uint64_t bytes = 0;

    // Becomes the other one where that is smaller.
    void improve(const ExportPlan& plan, const LodShape& shape, std::vector<bool> other_folds) {
        Layout other = layOut(plan, shape, other_folds);
        const std::uint64_t other_bytes = exportedBytes(plan, other);
        if (other_bytes < bytes)
            *this = {std::move(other_folds), std::move(other), other_bytes};
    }
};

} // namespace

std::string bufferFileName(const std::filesystem::path& gltf_path) {
    std::string stem = gltf_path.stem().string();
    constexpr std::string_view kExtension = ".bin";
    if (percentEncoded(stem).size() + kExtension.size() > kBufferNameWidth) {
        const std::string mark = std::to_string(stableHash(stem));
        while (percentEncoded(stem + mark).size() + kExtension.size() > kBufferNameWidth)
            stem.pop_back();
        stem += mark;
    }
    return stem + std::string(kExtension);
}

Layout chooseLayout(const ExportPlan& plan, const LodShape& shape) {
    Candidate best;
    best.folds.assign(plan.submeshes.size(), false);
    std::vector<CloseCall> close_calls;
    double gain_bytes = 0.0;
    for (std::uint32_t s = 0; s < plan.submeshes.size(); ++s) {
        const SubmeshPlan& submesh = plan.submeshes[s];
        const std::uint32_t kept = shape.submeshes[s].kept_instances;
        if (kept == 0 || submesh.row_bytes == 0.0)
            continue;
        const double gain =
            (submesh.node_bytes - submesh.row_bytes) * kept - submesh.fold_fixed_bytes;
        best.folds[s] = kept >= submesh.fold_from;
        gain_bytes += best.folds[s] ? gain : 0.0;
        if (std::abs(gain) < kCloseCallBytes)
            close_calls.push_back({std::abs(gain), s});
    }
    best.layout = layOut(plan, shape, best.folds);
    if (plan.options.instancing != Instancing::Auto)
        return std::move(best.layout);
    best.bytes = exportedBytes(plan, best.layout);
    std::ranges::stable_sort(close_calls, {}, &CloseCall::distance_bytes);
    close_calls.resize(std::min(close_calls.size(), kMostCloseCalls));
    for (const CloseCall& call : close_calls) {
        std::vector<bool> other = best.folds;
        other[call.submesh] = !other[call.submesh];
        best.improve(plan, shape, std::move(other));
    }
    if (gain_bytes < kExtensionBytes)
        best.improve(plan, shape, std::vector<bool>(best.folds.size(), false));
    return std::move(best.layout);
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
