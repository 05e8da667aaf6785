#include "bench/micro/hot_paths.h"

#include "bench/inputs.h"
#include "bench/peers/process.h"
#include "render/gpu_scene.h"
#include "scene/export.h"
#include "scene/generate.h"
#include "scene/import.h"
#include "simplify/algorithm.h"
#include "simplify/measure/distance.h"
#include "simplify/measure/image_difference.h"

#include <algorithm>
#include <array>
#include <benchmark/benchmark.h>
#include <numeric>
#include <optional>

namespace lodestone::bench {

namespace {

using benchmark::State;

// Times one iteration of `work`, which returns whether it went well.
template <class Work>
void add(const std::string& name, Work work) {
    benchmark::RegisterBenchmark(name.c_str(), [work = std::move(work)](State& state) mutable {
        for ([[maybe_unused]] const auto& iteration : state)
            if (!work()) {
                state.SkipWithError("failed");
                break;
            }
    })->Unit(benchmark::kMicrosecond);
}

std::vector<float> referenceNumbers() {
    std::vector<float> numbers(20'000);
    std::uint32_t bits = 1;
    for (float& number : numbers) {
        bits = 1'664'525U * bits + 1'013'904'223U;
        number = static_cast<float>(bits >> 8U);
    }
    return numbers;
}

void addReference() {
    add(kReferenceKernel, [numbers = referenceNumbers()] {
        std::vector<float> sorted = numbers;
        std::ranges::sort(sorted);
        float sum = std::accumulate(sorted.begin(), sorted.end(), 0.0F);
        benchmark::DoNotOptimize(sum);
        return true;
    });
}

// The maple by IAS, with two levels of detail to go back and forth between.
struct Maple {
    ScenePtr scene;
    LodSourcePtr source;
    std::shared_ptr<const ByteModel> bytes;
    std::array<std::uint64_t, 2> positions{};
    std::array<std::shared_ptr<const Lod>, 2> lods;
};

Result<Maple> makeMaple() {
    Result<ScenePtr> scene = generateScene("maple");
    if (!scene)
        return tl::unexpected(scene.error());
    Result<LodSourcePtr> source = findAlgorithm("ias")->prepare(*scene, {}, {}, {});
    if (!source)
        return tl::unexpected(source.error());
    Maple maple{*scene, *source, std::make_shared<ByteModel>(*scene, ExportOptions{}), {}, {}};
    for (std::size_t i = 0; i < 2; ++i) {
        const double ratio = i == 0 ? 0.2 : 0.1;
        maple.positions[i] =
            maple.source->resolve({Target::Kind::Ratio, ratio}, *maple.bytes).position;
        maple.lods[i] =
            std::make_shared<const Lod>(maple.source->readOut(maple.positions[i], nullptr));
    }
    return maple;
}

void addSequences(const Maple& maple) {
    for (const auto& [name, scene] :
         {std::pair{"sequence: sphere of 4,800 triangles, exact order", displacedSphere(20)},
          {"sequence: sphere of 30,000 triangles, near-greedy", displacedSphere(50)}})
        add(name, [scene = scene] {
            return findAlgorithm("quadric-submesh")->prepare(scene, {}, {}, {}).has_value();
        });
    add("sequence: maple, IAS", [scene = maple.scene] {
        return findAlgorithm("ias")->prepare(scene, {}, {}, {}).has_value();
    });
}

void addSchedules(const Maple& maple) {
    struct Named {
        const char* name;
        Ordering ordering;
    };

    for (const Named& by : {Named{"schedule: maple, by triangle", Ordering::Triangle},
                            Named{"schedule: maple, by byte", Ordering::Byte}})
        add(by.name, [maple, ordering = by.ordering] {
            return maple.source->rescheduled({ordering, {}, {}}, *maple.bytes) != nullptr;
        });
}

void addReadOuts(const Maple& maple) {
    add("read-out: maple, from the level before", [maple, turn = 0]() mutable {
        turn = 1 - turn;
        const auto from = static_cast<std::size_t>(turn);
        return maple.source->readOut(maple.positions[1 - from], maple.lods[from].get()).triangles >
               0;
    });
    add("read-out: maple, from nothing",
        [maple] { return maple.source->readOut(maple.positions[0], nullptr).triangles > 0; });
}

// What a lane does while a parameter of a one-shot method is dragged.
Result<void> addReRuns() {
    struct Dragged {
        const char* id;
        const char* parameter;
        double value;
    };

    const ScenePtr sphere = displacedSphere(50);
    for (const Dragged& dragged : {Dragged{"ss", "radius", 1.5}, Dragged{"fad", "angle", 20.0}}) {
        const Algorithm* row = findAlgorithm(dragged.id);
        const Result<LodSourcePtr> welded = row->prepare(sphere, {}, {}, {});
        if (!welded)
            return tl::unexpected(welded.error());
        add("re-run: sphere of 30,000 triangles, " + std::string(row->short_name),
            [row, dragged, welded = *welded] {
                const Result<LodSourcePtr> again =
                    row->prepareLike(*welded, {{dragged.parameter, dragged.value}}, {}, {});
                return again && (*again)->readOut(1, nullptr).triangles > 0;
            });
    }
    return {};
}

void addSizes(const Maple& maple) {
    add("size prediction: maple at one position",
        [maple] { return maple.bytes->bytes(maple.source->shapeAt(maple.positions[0])) > 0; });
    add("size prediction: maple prepared", [scene = maple.scene] {
        const ByteModel bytes(scene, ExportOptions{});
        return bytes.bytesPerTriangle(0, 0) > 0.0;
    });
}

void addFiles(const Maple& maple) {
    const auto scratch = std::make_shared<const ScratchFolder>();
    const std::filesystem::path path = scratch->path() / "maple.glb";
    const auto write = [maple, scratch, path] {
        return exportScene(*maple.scene, *maple.lods[0], path, {}).has_value();
    };
    add("export: maple at 20 %", write);
    if (write())
        add("import: maple at 20 %", [scratch, path] { return importScene(path, {}).has_value(); });
}

void addMeasures(const Maple& maple) {
    add("distance: maple at 20 %, 2 x 20,000 samples",
        [maple, full = std::make_shared<const Lod>(fullLod(*maple.scene))] {
            return measureDistance({maple.scene.get(), full.get()},
                                   {maple.scene.get(), maple.lods[0].get()},
                                   {20'000},
                                   {})
                .has_value();
        });
    Picture black{128, 128, std::vector<std::uint8_t>(std::size_t{4} * 128 * 128, 0)};
    Picture grey{128, 128, std::vector<std::uint8_t>(std::size_t{4} * 128 * 128, 128)};
    add("image difference: 128 x 128 px",
        [black, grey] { return comparePictures(black, grey, {}, {}).has_value(); });
}

// Lives as long as the benchmarks that draw with it.
struct Gpu {
    std::unique_ptr<GlContext> context;
    std::optional<Renderer> renderer;
    std::optional<GpuScene> scene;
    LodHandle lod;
};

Result<void> addUpload(const Maple& maple) {
    const auto gpu = std::make_shared<Gpu>();
    Result<std::unique_ptr<GlContext>> context = createHeadlessContext();
    if (!context)
        return tl::unexpected(context.error());
    gpu->context = std::move(*context);
    Result<Renderer> renderer = Renderer::create(*gpu->context);
    if (!renderer)
        return tl::unexpected(renderer.error());
    gpu->renderer = *renderer;
    Result<GpuScene> scene = GpuScene::create(*renderer, maple.scene);
    if (!scene)
        return tl::unexpected(scene.error());
    gpu->scene = std::move(*scene);
    add("upload: maple, from one level to another", [gpu, maple, turn = 0]() mutable {
        turn = 1 - turn;
        return gpu->scene->update(gpu->lod, *maple.lods[static_cast<std::size_t>(turn)])
            .has_value();
    });
    return {};
}

} // namespace

Result<std::string> registerHotPaths() {
    const Result<Maple> maple = makeMaple();
    if (!maple)
        return tl::unexpected(maple.error());
    addReference();
    addSequences(*maple);
    addSchedules(*maple);
    addReadOuts(*maple);
    if (const Result<void> added = addReRuns(); !added)
        return tl::unexpected(added.error());
    addSizes(*maple);
    addFiles(*maple);
    addMeasures(*maple);
    const Result<void> upload = addUpload(*maple);
    return upload ? std::string() : "not measured: upload: " + upload.error().message;
}

} // namespace lodestone::bench
