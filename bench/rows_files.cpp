#include "bench/peers/process.h"
#include "bench/rows.h"
#include "scene/expand.h"
#include "scene/import.h"

#include <fmt/core.h>

namespace lodestone::bench {

namespace {

Result<std::uint64_t>
writtenBytes(const Scene& scene, const Lod& lod, const std::filesystem::path& path) {
    const Result<ExportReport> report = exportScene(scene, lod, path, {});
    if (!report)
        return tl::unexpected(report.error());
    return report->bytes;
}

// The file of a source's LOD at 20 %.
Result<std::uint64_t> bytesAt20(const LodSource& source, const std::filesystem::path& path) {
    const ByteModel bytes(source.scene(), ExportOptions{});
    const Resolved at = source.resolve({Target::Kind::Ratio, 0.2}, bytes);
    return writtenBytes(*source.scene(), source.readOut(at.position, nullptr), path);
}

Result<void> addSizes(Table& table, const ScenePtr& maple, const std::filesystem::path& folder) {
    const Result<std::uint64_t> original =
        writtenBytes(*maple, fullLod(*maple), folder / "maple.glb");
    const Result<LodSourcePtr> ias = prepareIas(maple, {}, Ordering::Triangle);
    const Result<ScenePtr> expanded = expandScene(*maple, {});
    if (!original || !ias || !expanded)
        return tl::unexpected(!original ? original.error()
                                        : (ias ? expanded.error() : ias.error()));
    const Result<LodSourcePtr> quadric = prepareQuadric(*expanded, {});
    if (!quadric)
        return tl::unexpected(quadric.error());
    const Result<std::uint64_t> ias_bytes = bytesAt20(**ias, folder / "ias.glb");
    const Result<std::uint64_t> quadric_bytes = bytesAt20(**quadric, folder / "quadric.glb");
    if (!ias_bytes || !quadric_bytes)
        return tl::unexpected((ias_bytes ? quadric_bytes : ias_bytes).error());
    const auto size = static_cast<double>(*ias_bytes);
    table.ratioAtMost("maple at 20 %, file of IAS over Quadric's",
                      {size / static_cast<double>(*quadric_bytes),
                       1.0 / 20.0,
                       megabytesText(*ias_bytes),
                       megabytesText(*quadric_bytes)});
    table.ratioAtMost("maple at 20 %, file of IAS over the original",
                      {size / static_cast<double>(*original),
                       1.0,
                       megabytesText(*ias_bytes),
                       megabytesText(*original)});
    return {};
}

Result<void> addImport(Bench& bench, const std::filesystem::path& path) {
    const std::vector<Contender> contenders{
        {[&]() -> Result<std::shared_ptr<const void>> { return importScene(path, {}); }, 1}};
    const auto seconds = timeInTurns(contenders, bench.rounds);
    if (!seconds)
        return tl::unexpected(seconds.error());
    const Spread spread = spreadOf(seconds->front());
    bench.table.atMost("import of the maple GLB, CPU",
                       {spread.median, 1.0, secondsText(spread), secondsText(1.0), ""});
    return {};
}

// Sequences merged anew in another order.
Result<void> addReschedule(Bench& bench, const std::string& name) {
    const Result<ScenePtr> scene = bench.inputs.own(name);
    if (!scene)
        return tl::unexpected(scene.error());
    const Result<LodSourcePtr> source = prepareIas(*scene, {}, Ordering::Triangle);
    if (!source)
        return tl::unexpected(source.error());
    const ByteModel bytes(*scene, ExportOptions{});

    struct Named {
        Ordering ordering;
        const char* name;
    };

    for (const Named& by : {Named{Ordering::Triangle, "triangle"},
                            Named{Ordering::Byte, "byte"},
                            Named{Ordering::Cost, "cost"}}) {
        const std::vector<Contender> contenders{
            {[&]() -> Result<std::shared_ptr<const void>> {
                 return (*source)->rescheduled({by.ordering, {}, {}}, bytes);
             },
             5}};
        const auto seconds = timeInTurns(contenders, bench.rounds);
        if (!seconds)
            return tl::unexpected(seconds.error());
        const Spread spread = spreadOf(seconds->front());
        bench.table.atMost(fmt::format("{}, IAS: schedule by {}, {} positions, CPU",
                                       name,
                                       by.name,
                                       countText((*source)->positionCount())),
                           {spread.median, 0.010, secondsText(spread), secondsText(0.010), ""});
    }
    return {};
}

} // namespace

Result<void> addFileRows(Bench& bench) {
    const ScratchFolder scratch;
    const Result<ScenePtr> maple = bench.inputs.own("maple");
    if (!maple)
        return tl::unexpected(maple.error());
    Result<void> added = addSizes(bench.table, *maple, scratch.path());
    if (added)
        added = addImport(bench, scratch.path() / "maple.glb");
    for (const char* name : {"maple", "village"})
        if (added)
            added = addReschedule(bench, name);
    return added;
}

} // namespace lodestone::bench
