#include "app/cli_run.h"

#include "scene/expand.h"
#include "scene/import.h"
#include "simplify/bake/bake_parameters.h"

#include <algorithm>
#include <chrono>
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

// The LOD becomes a scene of its own, with new textures.
Result<void> transferTextures(RunOutcome& outcome,
                              const BakeOptions& options,
                              const ExportOptions& export_options,
                              const JobContext& job) {
    const Stopwatch watch;
    Result<BakedScene> baked = outcome.source->transferred(*outcome.lod, options, job);
    if (!baked)
        return tl::unexpected<Error>(std::move(baked.error()));
    outcome.scene = std::move(baked->scene);
    outcome.lod = std::make_shared<const Lod>(fullLod(*outcome.scene));
    const ByteModel bytes(outcome.scene, export_options);
    outcome.predicted_bytes = bytes.bytes(shapeOf(*outcome.scene, *outcome.lod));
    outcome.bytes = outcome.predicted_bytes;
    outcome.seconds.readout += watch.seconds();
    std::ranges::move(baked->notes, std::back_inserter(outcome.notes));
    if (baked->texels_per_unit > 0.0)
        outcome.notes.push_back(
            fmt::format("transferred textures: {:.4g} texels a unit", baked->texels_per_unit));
    return {};
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
        if (const auto bake = bakeOptions(*request.algorithm, request.parameters))
            if (Result<void> done = transferTextures(outcome, *bake, request.export_options, job);
                !done)
                return tl::unexpected<Error>(std::move(done.error()));
    }
    if (job.stopRequested())
        return cancelled();
    if (request.measure) {
        const Result<Distance> distance = measureOutcome(*request.scene, outcome, job);
        if (!distance)
            return tl::unexpected<Error>(distance.error());
        outcome.distance = *distance;
    }
    return outcome;
}

Result<Distance>
measureOutcome(const Scene& original, const RunOutcome& outcome, const JobContext& job) {
    const Lod full = fullLod(original);
    return measureDistance(
        {&original, &full}, {outcome.scene.get(), outcome.lod.get()}, DistanceOptions{}, job);
}

} // namespace lodestone
