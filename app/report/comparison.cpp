#include "app/report/comparison.h"

#include "app/image_measure.h"
#include "app/report/png.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <fmt/core.h>

namespace lodestone {

namespace {

// A folder that nobody else has, gone at the end with all that is in it.
class TemporaryFolder {
public:
    static Result<TemporaryFolder> create() {
        std::error_code error;
        std::string pattern =
            (std::filesystem::temp_directory_path(error) / "lodestone-compare-XXXXXX").string();
        if (error || !mkdtemp(pattern.data()))
            return fail(ErrorKind::Failed,
                        fmt::format("{}: no temporary folder can be made; set TMPDIR to one that "
                                    "can be written to",
                                    pattern));
        return TemporaryFolder(pattern);
    }

    TemporaryFolder(TemporaryFolder&& other) noexcept : path_(std::move(other.path_)) {
        other.path_.clear();
    }

    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(TemporaryFolder&&) = delete;

    ~TemporaryFolder() {
        std::error_code ignored;
        if (!path_.empty())
            std::filesystem::remove_all(path_, ignored);
    }

    const std::filesystem::path& path() const { return path_; }

private:
    explicit TemporaryFolder(std::filesystem::path path) : path_(std::move(path)) {}

    std::filesystem::path path_;
};

// Writes the row's level of detail and takes bytes, parts and time from the file.
Result<void> writeRow(ComparisonRow& row, const TemporaryFolder& folder) {
    RunOutcome& outcome = row.outcome;
    const std::filesystem::path path = folder.path() / "lod.glb";
    const auto start = std::chrono::steady_clock::now();
    Result<ExportReport> report = exportScene(*outcome.scene, *outcome.lod, path, {});
    if (!report)
        return tl::unexpected<Error>(std::move(report.error()));
    outcome.seconds.write =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::ranges::move(report->notes, std::back_inserter(outcome.notes));
    std::error_code error;
    outcome.bytes = std::filesystem::file_size(path, error);
    if (error)
        return fail(ErrorKind::Failed,
                    fmt::format("{}: cannot be read ({})", path.string(), error.message()));
    const Result<ByteParts> parts = splitGlbFile(path);
    if (!parts)
        return tl::unexpected<Error>(parts.error());
    row.parts = *parts;
    return {};
}

Result<std::vector<CurvePoint>>
traceCurve(const Scene& original, const RunOutcome& outcome, const JobContext& job) {
    static constexpr std::array<double, 7> kRatios = {1.0, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01};
    constexpr std::uint64_t kSamples = 50'000;
    const LodSource& source = *outcome.source;
    const ByteModel bytes(source.scene(), {});
    const Lod full = fullLod(original);
    std::vector<CurvePoint> curve;
    std::optional<std::uint64_t> last;
    Lod lod;
    for (std::size_t i = 0; i < kRatios.size(); ++i) {
        const Resolved resolved = source.resolve({Target::Kind::Ratio, kRatios[i]}, bytes);
        if (last == resolved.position)
            continue;
        lod = source.readOut(resolved.position, last ? &lod : nullptr);
        last = resolved.position;
        if (job.stopRequested())
            return cancelled();
        if (lod.triangles == 0)
            break; // there is no distance from nothing
        const bool whole = resolved.position == 0;
        const Result<Distance> distance =
            whole
                ? Distance{}
                : measureDistance(
                      {&original, &full}, {source.scene().get(), &lod}, {.samples = kSamples}, job);
        if (!distance)
            return tl::unexpected<Error>(distance.error());
        curve.push_back({lod.triangles,
                         bytes.bytes(source.shapeAt(resolved.position)),
                         distance->hausdorff,
                         distance->mean});
        job.report(static_cast<double>(i + 1) / static_cast<double>(kRatios.size()));
    }
    return curve;
}

ModelFacts modelFacts(const Scene& scene) {
    ModelFacts facts;
    facts.name = scene.name;
    facts.counts = countScene(scene);
    facts.materials = scene.materials.size();
    facts.images = scene.images.size();
    facts.file_bytes = scene.file_bytes;
    facts.diagonal = robustWorldBounds(scene).diagonal();
    facts.notes = scene.notes;
    return facts;
}

// One comparison while it is made.
class Runner {
public:
    Runner(const ComparisonRequest& request, ProgressBar& bar, const TemporaryFolder& folder)
        : request_(request), bar_(bar), folder_(folder) {}

    Result<ComparisonRow> row(const Algorithm* algorithm) {
        ComparisonRow row;
        row.algorithm = algorithm;
        RunRequest run;
        run.scene = request_.input.scene;
        run.algorithm = algorithm;
        run.target = request_.target;
        run.measure = algorithm != nullptr;
        const std::string_view id = algorithm ? algorithm->id : "original";
        bar_.stage(fmt::format("compare {}", id));
        Result<RunOutcome> outcome = runAlgorithm(run, bar_.context());
        if (!outcome)
            return tl::unexpected<Error>(std::move(outcome.error()));
        row.outcome = std::move(*outcome);
        row.outcome.seconds.load = request_.input.seconds;
        if (Result<void> written = writeRow(row, folder_); !written)
            return tl::unexpected<Error>(std::move(written.error()));
        if (algorithm && request_.depth == ComparisonRequest::Depth::Page) {
            bar_.stage(fmt::format("curve of {}", id));
            auto curve = traceCurve(*run.scene, row.outcome, bar_.context());
            if (!curve)
                return tl::unexpected<Error>(std::move(curve.error()));
            row.curve = std::move(*curve);
        }
        row.outcome.source.reset(); // large, and of no further use
        return row;
    }

    // Image differences, and pictures if the page wants them.
    Result<void> draw(Comparison& comparison, ImageSource& images) {
        std::vector<ComparisonRow*> drawn{&comparison.original};
        for (ComparisonRow& row : comparison.rows)
            if (!row.failed())
                drawn.push_back(&row);
        std::vector<ImageColumn> columns;
        columns.reserve(drawn.size());
        for (const ComparisonRow* row : drawn)
            columns.push_back({row->outcome.scene, row->outcome.lod, {}});
        bar_.stage("compare pictures");
        auto differences = measureImages(images, columns, {}, bar_.context());
        if (!differences)
            return tl::unexpected<Error>(std::move(differences.error()));
        for (std::size_t i = 1; i < drawn.size(); ++i)
            drawn[i]->image = (*differences)[i - 1];
        if (request_.depth == ComparisonRequest::Depth::Numbers)
            return {};
        bar_.stage("draw");
        const CameraState usual;
        PictureRequest request;
        request.columns = std::move(columns);
        request.views = {{usual.azimuth_deg, usual.elevation_deg, 0.0}};
        request.width_px = 1200;
        request.height_px = 900;
        const auto take = [&](PictureOrigin origin, const Picture& picture) -> Result<void> {
            return encodePng(picture).map(
                [&](std::string&& png) { drawn[origin.column]->picture_png = std::move(png); });
        };
        return images.draw(request, take, bar_.context());
    }

private:
    const ComparisonRequest& request_;
    ProgressBar& bar_;
    const TemporaryFolder& folder_;
};

// All rows; those that fail say so.
Result<void> runRows(const ComparisonRequest& request, Runner& runner, Comparison& comparison) {
    std::optional<Error> first_failure;
    std::size_t failures = 0;
    for (const Algorithm* algorithm : request.algorithms) {
        Result<ComparisonRow> row = runner.row(algorithm);
        if (!row) {
            if (row.error().kind == ErrorKind::Cancelled)
                return tl::unexpected<Error>(std::move(row.error()));
            ComparisonRow failed;
            failed.algorithm = algorithm;
            failed.failure = row.error().message;
            comparison.rows.push_back(std::move(failed));
            ++failures;
            row.error().message = fmt::format("{}: {}", algorithm->id, row.error().message);
            if (!first_failure)
                first_failure = std::move(row.error());
            continue;
        }
        comparison.rows.push_back(std::move(*row));
    }
    if (first_failure && failures == request.algorithms.size())
        return tl::unexpected<Error>(std::move(*first_failure));
    return {};
}

} // namespace

Result<Comparison>
runComparison(const ComparisonRequest& request, ImageSource* images, ProgressBar& bar) {
    const Result<TemporaryFolder> folder = TemporaryFolder::create();
    if (!folder)
        return tl::unexpected<Error>(folder.error());
    Comparison comparison;
    comparison.model = modelFacts(*request.input.scene);
    comparison.target = request.target;
    comparison.machine = thisMachine();
    Runner runner(request, bar, *folder);
    Result<ComparisonRow> original = runner.row(nullptr);
    if (!original)
        return tl::unexpected<Error>(std::move(original.error()));
    comparison.original = std::move(*original);
    if (Result<void> rows = runRows(request, runner, comparison); !rows)
        return tl::unexpected<Error>(std::move(rows.error()));
    if (!images) {
        comparison.pictures_missing = "this build draws no pictures";
        return comparison;
    }
    if (const Result<void> drawn = runner.draw(comparison, *images); !drawn) {
        if (drawn.error().kind == ErrorKind::Cancelled)
            return tl::unexpected<Error>(drawn.error());
        comparison.pictures_missing = drawn.error().message;
    }
    return comparison;
}

std::vector<const ComparisonRow*> competingRows(const Comparison& comparison) {
    std::vector<const ComparisonRow*> rows;
    for (const ComparisonRow& row : comparison.rows)
        if (!row.failed())
            rows.push_back(&row);
    const auto missed = [](const ComparisonRow* row) { return !row->outcome.target_met; };
    if (!std::ranges::all_of(rows, missed))
        std::erase_if(rows, missed);
    return rows;
}

std::optional<double> targetDeviation(const Comparison& comparison, const ComparisonRow& row) {
    if (row.failed() || comparison.target.kind == Target::Kind::Error)
        return std::nullopt;
    double reached = static_cast<double>(row.outcome.lod->triangles);
    double wanted = comparison.target.value;
    if (comparison.target.kind == Target::Kind::Bytes)
        reached = static_cast<double>(row.outcome.bytes);
    if (comparison.target.kind == Target::Kind::Ratio)
        wanted *= static_cast<double>(comparison.original.outcome.lod->triangles);
    if (wanted <= 0.0)
        return std::nullopt;
    return reached / wanted - 1.0;
}

} // namespace lodestone
