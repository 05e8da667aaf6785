#include "simplify/collapse/prepare.h"

#include "scene/expand.h"

namespace lodestone {

Result<CollapseInput>
expandInput(const Scene& scene, const ScheduleOptions& schedule, const JobContext& job) {
    Result<ScenePtr> expanded = expandScene(scene, job);
    if (!expanded)
        return tl::unexpected(expanded.error());
    return CollapseInput{std::move(*expanded), {schedule.ordering, {}, {}}};
}

Result<LodSourcePtr> prepareExpanded(const Scene& scene,
                                     EdgeCollapseOptions options,
                                     const ScheduleOptions& schedule,
                                     const JobContext& job) {
    options.remove_instances = false;
    const Result<CollapseInput> input = expandInput(scene, schedule, job);
    if (!input)
        return tl::unexpected(input.error());
    return prepareEdgeCollapse(input->scene, options, input->schedule, job);
}

double instancesPerSubmesh(const Scene& scene) {
    const SceneCounts counts = countScene(scene);
    return counts.submeshes == 0
               ? 0.0
               : static_cast<double>(counts.instances) / static_cast<double>(counts.submeshes);
}

} // namespace lodestone
