#include "scene/export.h"

#include "scene/atomic_file.h"
#include "scene/expansion.h"
#include "scene/gltf/writer.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
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

Result<void>
writeBuffer(AtomicFile& file, const ExportPlan& plan, const Layout& layout, const Lod& lod) {
    Result<void> result;
    writeBinary(plan, layout, lod, [&](std::span<const std::byte> bytes) {
        result = file.write(bytes);
        return result.has_value();
    });
    return result;
}

Result<void>
writeGlb(const fs::path& path, const ExportPlan& plan, const Layout& layout, const Lod& lod) {
    Result<std::string> text = exportedJson(plan, layout, lod, "");
    if (!text)
        return tl::unexpected(text.error());
    text->resize((text->size() + 3) & ~std::size_t{3}, ' ');
    const std::uint64_t bytes = exportedBytes(plan, layout);
    if (bytes > std::numeric_limits<std::uint32_t>::max())
        return fail(ErrorKind::Failed,
                    path.string() + ": a .glb holds at most 4 GiB; write a .gltf instead");
    Result<AtomicFile> file = AtomicFile::create(path);
    if (!file)
        return tl::unexpected(file.error());
    const auto total = static_cast<std::uint32_t>(bytes);
    const auto json_bytes = static_cast<std::uint32_t>(text->size());
    Result<void> done =
        writeNumbers(*file, std::array{kGlbMagic, 2U, total, json_bytes, kJsonChunk}).and_then([&] {
            return file->write(bytesOf(*text));
        });
    if (done && layout.binary_bytes > 0)
        done = writeNumbers(
                   *file, std::array{static_cast<std::uint32_t>(layout.binary_bytes), kBinaryChunk})
                   .and_then([&] { return writeBuffer(*file, plan, layout, lod); });
    return done.and_then([&] { return file->commit(); });
}

// Images first, then the buffer, the .gltf that refers to them last.
Result<void>
writeGltf(const fs::path& path, const ExportPlan& plan, const Layout& layout, const Lod& lod) {
    const std::string buffer_name = bufferFileName(path);
    Result<std::string> text = exportedJson(plan, layout, lod, buffer_name);
    if (!text)
        return tl::unexpected(text.error());
    std::vector<AtomicFile> files;
    const auto add = [&](const fs::path& target, const auto& write) -> Result<void> {
        Result<AtomicFile> file = AtomicFile::create(target);
        if (!file)
            return tl::unexpected(file.error());
        files.push_back(std::move(*file));
        return write(files.back());
    };
    Result<void> done;
    for (const ImageFile& image : plan.image_files) {
        const fs::path target = path.parent_path() / image.path;
        std::error_code error;
        if (image.path.has_parent_path())
            fs::create_directories(target.parent_path(), error);
        if (done)
            done = add(target, [&](AtomicFile& file) { return file.write(*image.bytes); });
    }
    if (done && layout.binary_bytes > 0)
        done = add(path.parent_path() / buffer_name,
                   [&](AtomicFile& file) { return writeBuffer(file, plan, layout, lod); });
    if (done)
        done = add(path, [&](AtomicFile& file) { return file.write(bytesOf(*text)); });
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

ExportReport reportOf(const ExportPlan& plan, const Layout& layout, const LodShape& shape) {
    ExportReport report;
    report.bytes = exportedBytes(plan, layout);
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

struct Target {
    fs::path path;
    ExportOptions options;
};

Result<ExportReport>
writeScene(const Scene& scene, const Lod& lod, const LodShape& shape, const Target& target) {
    const ExportPlan plan(scene, target.options);
    const Layout layout = chooseLayout(plan, shape);
    const Result<void> done = target.options.container == Container::Gltf
                                  ? writeGltf(target.path, plan, layout, lod)
                                  : writeGlb(target.path, plan, layout, lod);
    if (!done)
        return tl::unexpected(done.error());
    return reportOf(plan, layout, shape);
}

} // namespace

Result<ExportReport> exportScene(const Scene& scene,
                                 const Lod& lod,
                                 const fs::path& path,
                                 const ExportOptions& options) {
    ExportOptions used = options;
    used.container = isGltfPath(path, options.container) ? Container::Gltf : Container::Glb;
    if (used.instancing != Instancing::Expand)
        return writeScene(scene, lod, shapeOf(scene, lod), {path, used});
    const Expansion expansion = planExpansion(scene);
    Result<Lod> expanded = expandLod(expansion, scene, lod, {});
    if (!expanded)
        return tl::unexpected(expanded.error());
    const LodShape shape = expandShape(expansion, scene, shapeOf(scene, lod));
    return writeScene(*expansion.skeleton, *expanded, shape, {path, used});
}

} // namespace lodestone
