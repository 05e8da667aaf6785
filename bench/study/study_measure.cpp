#include "bench/study/study_measure.h"

#include "bench/study/pieces.h"
#include "bench/timing.h"
#include "scene/expand.h"
#include "scene/generate.h"
#include "simplify/algorithm.h"
#include "simplify/measure/distance.h"

#include <array>

namespace lodestone::bench {

namespace {

Result<LodSourcePtr> prepare(const char* algorithm,
                             const ScenePtr& scene,
                             Ordering ordering,
                             const ParameterValues& values = {}) {
    return findAlgorithm(algorithm)->prepare(scene, values, {ordering, {}, {}}, {});
}

// A source with the sizes of its LODs.
struct Sized {
    explicit Sized(LodSourcePtr of) : source(std::move(of)), bytes(source->scene(), {}) {}

    StudyLevel levelAt(std::uint64_t position) const {
        StudyLevel level;
        level.triangles = source->trianglesAt(position);
        level.bytes = bytes.bytes(source->shapeAt(position));
        return level;
    }

    std::uint64_t positionFor(double triangles) const {
        return source->resolve({Target::Kind::Triangles, triangles}, bytes).position;
    }

    LodSourcePtr source;
    ByteModel bytes;
};

// A level and how far it is from the original.
struct Measured {
    StudyLevel level;
    Lod lod;
};

Result<Measured>
measured(const Scene& original, const Sized& of, double triangles, std::uint64_t samples) {
    const std::uint64_t position = of.positionFor(triangles);
    Measured result{of.levelAt(position), of.source->readOut(position, nullptr)};
    const Lod full = fullLod(original);
    const Result<Distance> distance =
        measureDistance({&original, &full}, {of.source->scene().get(), &result.lod}, {samples}, {});
    if (!distance)
        return tl::unexpected(distance.error());
    result.level.hausdorff = distance->hausdorff;
    result.level.mean = distance->mean;
    return result;
}

Result<void> measureIas(StudyRow& row, const ScenePtr& scene, const StudyOptions& options) {
    const double limit = options.ratio * static_cast<double>(row.counts.triangles);
    const Result<LodSourcePtr> ias = prepare("ias", scene, Ordering::Triangle);
    if (!ias)
        return tl::unexpected(ias.error());
    const Sized by_triangle(*ias);
    row.original_bytes = by_triangle.levelAt(0).bytes;
    Result<Measured> level = measured(*scene, by_triangle, limit, options.samples);
    if (!level)
        return tl::unexpected(level.error());
    row.ias = level->level;
    row.removed = row.counts.instances - level->lod.instances;
    const Sized by_cost((*ias)->rescheduled({Ordering::Cost, {}, {}}, by_triangle.bytes));
    level = measured(*scene, by_cost, limit, options.samples);
    if (!level)
        return tl::unexpected(level.error());
    row.by_cost = level->level;
    const Result<LodSourcePtr> by_size =
        prepare("ias", scene, Ordering::Triangle, {{"ips-switch", 2.0}});
    if (!by_size)
        return tl::unexpected(by_size.error());
    row.by_size = row.ias;
    if ((*by_size)->scene() == scene)
        return {};
    level =
        measured(*scene, Sized(*by_size), static_cast<double>(row.ias.triangles), options.samples);
    if (!level)
        return tl::unexpected(level.error());
    row.by_size = level->level;
    return {};
}

Result<void> measureLevels(StudyRow& row, const ScenePtr& scene, const StudyOptions& options) {
    if (Result<void> done = measureIas(row, scene, options); !done)
        return done;
    const Result<LodSourcePtr> quadric = prepare("quadric", scene, Ordering::Triangle);
    if (!quadric)
        return tl::unexpected(quadric.error());
    const Result<Measured> level =
        measured(*scene, Sized(*quadric), static_cast<double>(row.ias.triangles), options.samples);
    if (!level)
        return tl::unexpected(level.error());
    row.quadric = level->level;
    const Scene& expanded = *(*quadric)->scene();
    row.pieces = countPieces(expanded, fullLod(expanded));
    const std::uint64_t left = countPieces(expanded, level->lod);
    row.pieces_lost = row.pieces - std::min(left, row.pieces);
    return {};
}

double reductionPercent(const StudyLevel& ours, const StudyLevel& theirs) {
    return theirs.bytes == 0 ? 0.0
                             : 100.0 * (1.0 - static_cast<double>(ours.bytes) /
                                                  static_cast<double>(theirs.bytes));
}

} // namespace

double StudyRow::ips() const {
    return counts.submeshes == 0
               ? 0.0
               : static_cast<double>(counts.instances) / static_cast<double>(counts.submeshes);
}

double StudyRow::sizeReductionPercent() const {
    return reductionPercent(ias, quadric);
}

double StudyRow::costSizeReductionPercent() const {
    return reductionPercent(by_cost, quadric);
}

double StudyRow::bestSizeReductionPercent() const {
    return reductionPercent(by_size, quadric);
}

StudyRow measureModel(const StudyModel& model, const StudyOptions& options) {
    StudyRow row;
    row.name = model.name;
    row.kind = model.kind;
    const Result<ScenePtr> scene = model.make();
    if (!scene) {
        row.failure = scene.error().message;
        return row;
    }
    row.counts = countScene(**scene);
    if (row.counts.triangles == 0)
        row.failure = "no triangles";
    else if (row.counts.triangles > options.most_triangles)
        row.failure = "more triangles than the study goes to";
    else if (const Result<void> done = measureLevels(row, *scene, options); !done)
        row.failure = done.error().message;
    return row;
}

Result<TableRow> measureTableRow(const std::string& sample, int rounds) {
    const Result<ScenePtr> scene = generateScene(sample);
    if (!scene)
        return tl::unexpected(scene.error());
    using Made = Result<std::shared_ptr<const void>>;
    const std::vector<Contender> contenders{
        {[&]() -> Made { return prepare("quadric", *scene, Ordering::Cost); }, 1},
        {[&]() -> Made { return prepare("ias", *scene, Ordering::Cost); }, 1}};
    const auto seconds = timeInTurns(contenders, rounds);
    if (!seconds)
        return tl::unexpected(seconds.error());
    TableRow row;
    row.name = sample;
    row.counts = countScene(**scene);
    row.quadric_seconds = spreadOf((*seconds)[0]).median;
    row.ias_seconds = spreadOf((*seconds)[1]).median;
    row.time_ratio = medianRatio((*seconds)[0], (*seconds)[1]);
    const double limit = 0.2 * static_cast<double>(row.counts.triangles);
    for (const auto& [algorithm, ordering, to] :
         {std::tuple{"quadric", Ordering::Cost, &row.quadric},
          {"ias", Ordering::Cost, &row.by_cost},
          {"ias", Ordering::Triangle, &row.ias}}) {
        const Result<LodSourcePtr> source = prepare(algorithm, *scene, ordering);
        if (!source)
            return tl::unexpected(source.error());
        const Sized sized(*source);
        *to = sized.levelAt(sized.positionFor(limit));
        if (std::string(algorithm) == "ias")
            row.original_bytes = sized.levelAt(0).bytes;
    }
    return row;
}

Result<std::vector<SizeCurve>> measureSizeCurves(const ScenePtr& scene) {
    constexpr std::array kShares{
        1.0, 0.8, 0.6, 0.5, 0.4, 0.3, 0.2, 0.15, 0.1, 0.07, 0.05, 0.03, 0.02, 0.01, 0.005, 0.002};

    struct Plan {
        const char* name;
        const char* algorithm;
        Ordering ordering;
    };

    std::vector<SizeCurve> curves;
    for (const Plan& plan : {Plan{"Quadric", "quadric", Ordering::Cost},
                             Plan{"IAS, ordering cost", "ias", Ordering::Cost},
                             Plan{"IAS, ordering triangle", "ias", Ordering::Triangle}}) {
        const Result<LodSourcePtr> source = prepare(plan.algorithm, scene, plan.ordering);
        if (!source)
            return tl::unexpected(source.error());
        const Sized sized(*source);
        SizeCurve curve{plan.name, {}};
        for (const double share : kShares)
            curve.levels.push_back(sized.levelAt(
                sized.positionFor(share * static_cast<double>(sized.source->trianglesAt(0)))));
        curves.push_back(std::move(curve));
    }
    return curves;
}

} // namespace lodestone::bench
