#include "bench/frame_turns.h"

#include "bench/timing.h"
#include "render/view.h"

namespace lodestone::bench {

namespace {

struct OnGpu {
    GpuScene scene;
    LodHandle lod;
};

Result<std::vector<OnGpu>> upload(const Renderer& renderer, std::span<const FrameColumn> columns) {
    std::vector<OnGpu> uploaded;
    for (const FrameColumn& column : columns) {
        auto scene = GpuScene::create(renderer, column.scene);
        if (!scene)
            return tl::unexpected(scene.error());
        LodHandle lod;
        if (const auto updated = scene->update(lod, *column.lod); !updated)
            return tl::unexpected(updated.error());
        uploaded.push_back({std::move(*scene), std::move(lod)});
    }
    return uploaded;
}

std::vector<View::Input> inputsFor(std::span<const OnGpu> columns, int size_px) {
    View::Input input;
    frameCamera(input.camera, columns[0].scene.framePoints(), 1.0);
    input.options.samples = 1;
    input.size = {size_px, size_px};
    std::vector<View::Input> inputs;
    for (const OnGpu& column : columns) {
        input.scene = &column.scene;
        input.lod = &column.lod;
        inputs.push_back(input);
    }
    return inputs;
}

} // namespace

Result<std::vector<FrameTimes>> timeFramesInTurns(std::span<const FrameColumn> columns,
                                                  const FrameTurns& turns) {
    std::vector<FrameTimes> times(columns.size());
    if (columns.empty())
        return times;
    const auto context = createHeadlessContext();
    if (!context)
        return tl::unexpected(context.error());
    const auto renderer = Renderer::create(**context);
    if (!renderer)
        return tl::unexpected(renderer.error());
    const Result<std::vector<OnGpu>> uploaded = upload(*renderer, columns);
    if (!uploaded)
        return tl::unexpected(uploaded.error());
    auto view = View::create(*renderer);
    if (!view)
        return tl::unexpected(view.error());
    const std::vector<View::Input> inputs = inputsFor(*uploaded, turns.size_px);
    double begun = 0.0; // the second turn
    for (int turn = 0; turn < turns.turns; ++turn) {
        if (turn == 1)
            begun = wallSeconds();
        if (turn > 1 && turns.budget_s > 0.0 && wallSeconds() - begun >= turns.budget_s)
            break;
        for (std::size_t c = 0; c < inputs.size(); ++c) {
            const int warm_up = turn == 0 ? turns.warm_up : 1; // caches hold another's data
            const double cpu_begun = cpuSeconds();
            const auto measured = view->measure(inputs[c], {warm_up, turns.frames_a_turn, 0.0});
            if (!measured)
                return tl::unexpected(measured.error());
            times[c].wall_ms.push_back(measured->mean_ms);
            times[c].cpu_ms.push_back(1000.0 * (cpuSeconds() - cpu_begun) /
                                      (warm_up + turns.frames_a_turn));
        }
    }
    return times;
}

} // namespace lodestone::bench
