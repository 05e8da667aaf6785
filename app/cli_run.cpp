#include "app/cli_run.h"

#include "scene/expand.h"
#include "scene/import.h"
#include "simplify/bake/bake_parameters.h"
#include "simplify/bake/baked_size.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/core.h>
#include <iterator>

namespace lodestone {

namespace {

class Stopwatch {
public:
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

RunOutcome originalOutcome(const RunRequest& request) {
    RunOutcome outcome;
    outcome.algorithm = "original";
    outcome.name = "Original";
    outcome.scene = request.scene;
    outcome.lod = std::make_shared<const Lod>(fullLod(*request.scene));
    const ByteModel bytes(request.scene, request.export_options);
    outcome.predicted_bytes = bytes.bytes(shapeOf(*request.scene, *outcome.lod));
    outcome.bytes = outcome.predicted_bytes;
    return outcome;
}

RunOutcome runPrepared(const RunRequest& request, const LodSourcePtr& source) {
    RunOutcome outcome;
    outcome.algorithm = request.algorithm->id;
    outcome.name = request.algorithm->short_name;
    outcome.scene = source->scene();
    outcome.source = source;
    outcome.seconds.sequence = source->seconds_sequence;
    outcome.seconds.schedule = source->seconds_schedule;
    outcome.notes = source->notes();

    const ByteModel bytes(source->scene(), request.export_options);
    const Stopwatch watch;
    const Resolved resolved = source->resolve(request.target, bytes);
    outcome.lod = std::make_shared<const Lod>(source->readOut(resolved.position, nullptr));
    outcome.seconds.readout = watch.seconds();
    outcome.predicted_bytes = bytes.bytes(source->shapeAt(resolved.position));
    outcome.bytes = outcome.predicted_bytes;
    outcome.target_met = resolved.met;
    if (!resolved.note.empty())
        outcome.notes.push_back(resolved.note);
    return outcome;
}

// The LOD as a scene of its own, with new textures, and the size of its file.
struct Transferred {
    BakedScene baked;
    std::shared_ptr<const Lod> lod;
    std::uint64_t bytes = 0;
};

Result<Transferred> transferOnce(const LodSource& source,
                                 const Lod& lod,
                                 const BakeOptions& options,
                                 const ExportOptions& export_options,
                                 const JobContext& job) {
    Result<BakedScene> baked = source.transferred(lod, options, job);
    if (!baked)
        return tl::unexpected<Error>(std::move(baked.error()));
    Transferred made{std::move(*baked), nullptr, 0};
    made.lod = std::make_shared<const Lod>(fullLod(*made.baked.scene));
    const ByteModel bytes(made.baked.scene, export_options);
    made.bytes = bytes.bytes(shapeOf(*made.baked.scene, *made.lod));
    return made;
}

// What new textures add to a file, or take off it, decides which level a size leaves room for, and
// only making them tells. Guesses, then halves the logarithm of the triangles between levels that
// fit and those that do not; where not even the coarsest fits, atlases are halved.
Result<Transferred> transferWithin(const RunRequest& request,
                                   const RunOutcome& outcome,
                                   BakeOptions options,
                                   const JobContext& job) {
    constexpr int kTries = 12;      // from 8192 to 256 pixels takes five halvings
    constexpr double kClose = 0.95; // of the size wanted: not worth another transfer
    constexpr std::uint32_t kSmallestAtlas = 256;
    const LodSource& source = *outcome.source;
    const ByteModel kept(source.scene(), request.export_options);
    const double wanted = request.target.value;
    const auto before = static_cast<double>(outcome.predicted_bytes);
    const auto guess = static_cast<double>(
        estimateBakedBytes(*source.scene(), *outcome.lod, options, outcome.predicted_bytes));
    Target target{Target::Kind::Bytes, std::max(before + wanted - guess, 0.0)};
    const auto all = static_cast<double>(source.trianglesAt(0));
    double fits = 0.0;       // triangles of the finest level known to fit; 0: none
    double over = all + 1.0; // of the coarsest that does not
    std::optional<Transferred> best;
    for (int tried = 1;; ++tried) {
        const Resolved at = source.resolve(target, kept);
        const Lod lod = source.readOut(at.position, nullptr);
        Result<Transferred> made = transferOnce(source, lod, options, request.export_options, job);
        if (!made)
            return made;
        const auto triangles = static_cast<double>(lod.triangles);
        const auto bytes = static_cast<double>(made->bytes);
        const bool is_within = bytes <= wanted;
        const bool is_new = triangles > fits && triangles < over;
        if (is_within && triangles >= fits)
            best = *made;
        (is_within ? fits : over) = triangles;
        const bool is_coarsest = at.position + 1 == source.positionCount();
        const bool is_lost = !best && is_coarsest && options.atlas_px == kSmallestAtlas;
        const bool is_close = is_within && (bytes >= kClose * wanted || at.position == 0);
        if (is_lost || is_close || !is_new || tried == kTries)
            return best ? std::move(*best) : made;
        if (!best && is_coarsest) {
            options.atlas_px = std::max(options.atlas_px / 2, kSmallestAtlas);
            over = all + 1.0;
        }
        target = {Target::Kind::Triangles, best ? std::sqrt(fits * over) : 0.0};
    }
}

Result<void>
transferTextures(const RunRequest& request, RunOutcome& outcome, const JobContext& job) {
    const std::optional<BakeOptions> options = bakeOptions(*request.algorithm, request.parameters);
    if (!options)
        return {};
    const Stopwatch watch;
    const bool within = request.target.kind == Target::Kind::Bytes;
    Result<Transferred> made =
        within ? transferWithin(request, outcome, *options, job)
               : transferOnce(*outcome.source, *outcome.lod, *options, request.export_options, job);
    if (!made)
        return tl::unexpected<Error>(std::move(made.error()));
    outcome.scene = std::move(made->baked.scene);
    outcome.lod = std::move(made->lod);
    outcome.predicted_bytes = made->bytes;
    outcome.bytes = made->bytes;
    outcome.seconds.readout += watch.seconds();
    if (within) // what was told of the size counted the original's textures
        outcome.notes = outcome.source->notes();
    std::ranges::move(made->baked.notes, std::back_inserter(outcome.notes));
    if (made->baked.texels_per_unit > 0.0)
        outcome.notes.push_back(
            fmt::format("transferred textures: {:.4g} texels a unit", made->baked.texels_per_unit));
    if (within) {
        outcome.target_met = static_cast<double>(made->bytes) <= request.target.value;
        if (!outcome.target_met)
            outcome.notes.emplace_back("even the smallest atlases leave no room for the size that "
                                       "was asked for; try atlas-format=jpeg or merge-materials");
    }
    return {};
}

Result<Distance> distanceFrom(const Scene& original, const LodView& view, const JobContext& job) {
    const Lod full = fullLod(original);
    return measureDistance({&original, &full}, view, DistanceOptions{}, job);
}

} // namespace

Result<LoadedInput> loadInput(const std::filesystem::path& path, const JobContext& job) {
    const Stopwatch watch;
    Result<ScenePtr> scene = importScene(path, job);
    if (!scene)
        return tl::unexpected<Error>(std::move(scene.error()));
    return LoadedInput{std::move(*scene), watch.seconds()};
}

Result<RunOutcome> runAlgorithm(const RunRequest& request, const JobContext& job) {
    RunOutcome outcome;
    if (!request.algorithm) {
        outcome = originalOutcome(request);
    } else {
        ScenePtr input = request.scene;
        if (request.expand_first && !request.algorithm->expands) {
            Result<ScenePtr> expanded = expandScene(*input, job);
            if (!expanded)
                return tl::unexpected<Error>(std::move(expanded.error()));
            input = std::move(*expanded);
        }
        Result<LodSourcePtr> source =
            request.algorithm->prepare(input, request.parameters, request.schedule, job);
        if (!source)
            return tl::unexpected<Error>(std::move(source.error()));
        outcome = runPrepared(request, *source);
        if (Result<void> done = transferTextures(request, outcome, job); !done)
            return tl::unexpected<Error>(std::move(done.error()));
    }
    if (job.stopRequested())
        return cancelled();
    if (request.measure) {
        const Result<Distance> distance =
            distanceFrom(*request.scene, {outcome.scene.get(), outcome.lod.get()}, job);
        if (!distance)
            return tl::unexpected<Error>(distance.error());
        outcome.distance = *distance;
    }
    return outcome;
}

Result<Distance>
measureFile(const Scene& original, const std::filesystem::path& path, const JobContext& job) {
    const Result<ScenePtr> written = importScene(path, job);
    if (!written)
        return tl::unexpected<Error>(written.error());
    const Lod all = fullLod(**written);
    return distanceFrom(original, {written->get(), &all}, job);
}

} // namespace lodestone
