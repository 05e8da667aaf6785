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

bool hasFewInstances(const Scene& scene) {
    constexpr double kFew = 1.75; // instances a submesh (Azim et al. 2015)
    const SceneCounts counts = countScene(scene);
    return static_cast<double>(counts.instances) < kFew * static_cast<double>(counts.submeshes);
}

} // namespace lodestone
