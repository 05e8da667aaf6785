#include "scene/export.h"

#include "scene/atomic_file.h"
#include "scene/gltf/packed_export.h"
#include "scene/storage.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <functional>
#include <limits>

namespace lodestone {

namespace fs = std::filesystem;

namespace {

constexpr std::uint32_t kGlbMagic = 0x46546C67;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;

std::span<const std::byte> bytesOf(const std::string& text) {
    return std::as_bytes(std::span(text.data(), text.size()));
}

Result<void> writeNumbers(AtomicFile& file, std::span<const std::uint32_t> numbers) {
    return file.write(std::as_bytes(numbers));
}

// Document and binary of one export; the binary is made while it is written, or lies packed.
struct Content {
    std::string json;
    std::uint64_t binary_bytes = 0;
    std::uint64_t dropped_triangles = 0;
    std::function<Result<void>(AtomicFile&)> write_binary;
};

std::uint64_t paddedTo4(std::uint64_t size) {
    return (size + 3) & ~std::uint64_t{3};
}

std::uint64_t glbBytes(const Content& content) {
    constexpr std::uint64_t kHeaders = 12 + 8;
    return kHeaders + paddedTo4(content.json.size()) +
           (content.binary_bytes > 0 ? 8 + content.binary_bytes : 0);
}

// The last moment at which the files may be cancelled.
Result<void> passGate(const ExportGate& gate) {
    if (gate.stop.stop_requested() || (gate.may_replace && !gate.may_replace()))
        return cancelled();
    return {};
}

Result<void> writeGlb(const fs::path& path, Content content, const ExportGate& gate) {
    const std::uint64_t bytes = glbBytes(content);
    content.json.resize(paddedTo4(content.json.size()), ' ');
    if (bytes > std::numeric_limits<std::uint32_t>::max())
        return fail(ErrorKind::Failed,
                    path.string() + ": a .glb holds at most 4 GiB; write a .gltf instead");
    Result<AtomicFile> file = AtomicFile::create(path);
    if (!file)
        return tl::unexpected(file.error());
    const auto total = static_cast<std::uint32_t>(bytes);
    const auto json_bytes = static_cast<std::uint32_t>(content.json.size());
    Result<void> done =
        writeNumbers(*file, std::array{kGlbMagic, 2U, total, json_bytes, kJsonChunk}).and_then([&] {
            return file->write(bytesOf(content.json));
        });
    if (done && content.binary_bytes > 0)
        done =
            writeNumbers(*file,
                         std::array{static_cast<std::uint32_t>(content.binary_bytes), kBinaryChunk})
                .and_then([&] { return content.write_binary(*file); });
    return done.and_then([&] { return file->sync(); })
        .and_then([&] { return passGate(gate); })
        .and_then([&] { return file->commit(); });
}

// Images first, then the buffer, the .gltf that refers to them last.
Result<void> writeGltf(const fs::path& path,
                       std::span<const ImageFile> images,
                       const Content& content,
                       const ExportGate& gate) {
    std::vector<AtomicFile> files;
    const auto add = [&](const fs::path& target, const auto& write) -> Result<void> {
        if (gate.stop.stop_requested())
            return cancelled();
        Result<AtomicFile> file = AtomicFile::create(target);
        if (!file)
            return tl::unexpected(file.error());
        files.push_back(std::move(*file));
        return write(files.back()).and_then([&] { return files.back().sync(); });
    };
    Result<void> done;
    for (const ImageFile& image : images) {
        const fs::path target = path.parent_path() / image.path;
        std::error_code error;
        if (image.path.has_parent_path())
            fs::create_directories(target.parent_path(), error);
        if (done)
            done = add(target, [&](AtomicFile& file) { return file.write(*image.bytes); });
    }
    if (done && content.binary_bytes > 0)
        done = add(path.parent_path() / bufferFileName(path), content.write_binary);
    if (done)
        done = add(path, [&](AtomicFile& file) { return file.write(bytesOf(content.json)); });
    if (done)
        done = passGate(gate);
    for (AtomicFile& file : files)
        if (done)
            done = file.commit();
    return done;
}

bool isGltfPath(const fs::path& path, Container fallback) {
    std::string extension = path.extension().string();
    std::ranges::transform(extension, extension.begin(), [](char c) {
        return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    });
    if (extension == ".gltf")
        return true;
    return extension != ".glb" && fallback == Container::Gltf;
}

// All files.
std::uint64_t bytesOf(const ExportPlan& plan, const Content& content) {
    if (plan.options.container == Container::Glb)
        return glbBytes(content);
    std::uint64_t bytes = content.json.size() + content.binary_bytes;
    for (const ImageFile& image : plan.image_files)
        bytes += image.bytes->size();
    return bytes;
}

ExportReport reportOf(const ExportPlan& plan, const Layout& layout, const LodShape& shape) {
    ExportReport report;
    report.notes = plan.notes;
    std::uint64_t dropped_names = 0;
    for (std::size_t s = 0; s < plan.submeshes.size(); ++s) {
        const SubmeshPlan& submesh = plan.submeshes[s];
        bool rows = false;
        bool nodes = false;
        forEachKept(submesh.range, shape.submeshes[s], [&](std::uint32_t i) {
            const InstancePlan& instance = plan.instances[i];
            const bool is_row =
                instance.group != kNone && (layout.folds[s] || !plan.groups[instance.group].folded);
            rows |= is_row;
            nodes |= !is_row;
            dropped_names += is_row && instance.named ? 1 : 0;
        });
        report.submeshes_as_gpu_instances += rows ? 1 : 0;
        report.submeshes_as_nodes += nodes && !rows ? 1 : 0;
    }
    if (dropped_names > 0)
        report.notes.push_back("names of " + std::to_string(dropped_names) +
                               " nodes dropped: they became GPU instances");
    return report;
}

// plan, layout, lod and gate must outlive the content.
Result<Content> contentOf(const ExportPlan& plan,
                          const Layout& layout,
                          const Lod& lod,
                          const fs::path& path,
                          const ExportGate& gate) {
    if (isPacked(plan.options)) {
        Result<PackedDocument> packed = packedExport(plan, layout, lod, bufferFileName(path));
        if (!packed)
            return tl::unexpected(packed.error());
        const auto binary =
            std::make_shared<const std::vector<std::byte>>(std::move(packed->binary));
        return Content{dumpJson(packed->json),
                       binary->size(),
                       packed->dropped_triangles,
                       [binary](AtomicFile& file) { return file.write(*binary); }};
    }
    Result<std::string> text = exportedJson(plan, layout, lod, bufferFileName(path));
    if (!text)
        return tl::unexpected(text.error());
    return Content{std::move(*text), layout.binary_bytes, 0, [&](AtomicFile& file) {
                       Result<void> result;
                       writeBinary(plan, layout, lod, [&](std::span<const std::byte> bytes) {
                           result = gate.stop.stop_requested() ? Result<void>(cancelled())
                                                               : file.write(bytes);
                           return result.has_value();
                       });
                       return result;
                   }};
}

// Another plan where the LOD leaves the grids of the given one, wide enough for it; else null.
// bounds: of the submeshes, that gave the grids.
std::unique_ptr<const ExportPlan>
widerPlan(const ExportPlan& plan, std::vector<Bounds> bounds, const Lod& lod) {
    if (plan.options.compression == Compression::None)
        return nullptr;
    bool leaves = false;
    for (std::size_t s = 0; s < plan.grids.size(); ++s) {
        Bounds reached;
        for (const GeometryPtr& geometry : lod.submeshes[s].primitives)
            for (const glm::vec3& position : geometry->positions)
                reached.add(glm::dvec3(position));
        if (covers(plan.grids[s], reached))
            continue;
        bounds[s].add(reached.min);
        bounds[s].add(reached.max);
        leaves = true;
    }
    if (!leaves)
        return nullptr;
    return std::make_unique<const ExportPlan>(
        plan.scene, plan.options, planGrids(plan.scene, plan.options.compression, bounds));
}

Result<ExportReport> writeScene(const ExportPlan& plan,
                                const Lod& lod,
                                const StoredShape& stored,
                                const fs::path& path,
                                const ExportGate& gate) {
    const Result<Content> content = contentOf(plan, stored.layout, lod, path, gate);
    if (!content)
        return tl::unexpected(content.error());
    const Result<void> done = plan.options.container == Container::Gltf
                                  ? writeGltf(path, plan.image_files, *content, gate)
                                  : writeGlb(path, *content, gate);
    if (!done)
        return tl::unexpected(done.error());
    ExportReport report = reportOf(plan, stored.layout, stored.shape);
    report.bytes = bytesOf(plan, *content);
    if (content->dropped_triangles > 0)
        report.notes.push_back(std::to_string(content->dropped_triangles) +
                               " triangles with two equal corners left out: Draco has none");
    return report;
}

// What Instancing::Auto has chosen.
std::string
storageNote(const Scene& scene, const LodShape& shape, const std::vector<bool>& expanded) {
    std::uint32_t drawn_submeshes = 0;
    std::uint32_t expanded_submeshes = 0;
    std::uint64_t instances = 0;
    for (std::size_t s = 0; s < scene.submeshes.size(); ++s) {
        const std::uint32_t kept = shape.submeshes[s].kept_instances;
        drawn_submeshes += kept > 0 ? 1 : 0;
        if (!expanded[s] || kept == 0)
            continue;
        ++expanded_submeshes;
        instances += kept;
    }
    return "auto: kept " + std::to_string(drawn_submeshes - expanded_submeshes) + " of " +
           std::to_string(drawn_submeshes) +
           " submeshes instanced; smaller expanded and merged by "
           "material, without nodes and names of their own: " +
           std::to_string(expanded_submeshes) + " with " + std::to_string(instances) +
           (instances == 1 ? " instance" : " instances");
}

} // namespace

Result<ExportReport> exportScene(const Scene& scene,
                                 const Lod& lod,
                                 const fs::path& path,
                                 const ExportOptions& options,
                                 const ExportGate& gate) {
    ExportOptions used = options;
    used.container = isGltfPath(path, options.container) ? Container::Gltf : Container::Glb;
    const LodShape shape = shapeOf(scene, lod);
    const StoragePlan storage(scene, used);
    StoredShape stored = storage.smallest(shape);
    const Result<Lod> written = storage.storedLod(lod, stored.way);
    if (!written)
        return tl::unexpected(written.error());
    if (gate.stop.stop_requested())
        return cancelled();
    const std::unique_ptr<const ExportPlan> wider =
        widerPlan(storage.plan(), storage.bounds(), *written);
    if (wider)
        stored.layout = chooseLayout(*wider, stored.shape);
    Result<ExportReport> report =
        writeScene(wider ? *wider : storage.plan(), *written, stored, path, gate);
    if (report && stored.way > 0)
        report->notes.push_back(storageNote(scene, shape, storage.expanded(stored.way)));
    return report;
}

} // namespace lodestone
