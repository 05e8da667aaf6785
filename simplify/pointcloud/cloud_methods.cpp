// The methods as the source runs them: passes, retriangulation after each.
#include "simplify/pointcloud/cloud_method.h"
#include "simplify/pointcloud/methods.h"
#include "simplify/pointcloud/retriangulate.h"

#include <algorithm>

namespace lodestone {

namespace {

void runVertexTriplex(CloudSurface& surface,
                      const Complex& complex,
                      const CloudSettings& settings,
                      const JobContext& job) {
    for (double left = settings.main; left > 0.0 && !job.stopRequested(); left -= 1.0) {
        applyMerges(
            surface, vertexTriplex(surface, std::min(left, 1.0), settings.fidelity, job), complex);
        flipToDelaunay(surface, job);
    }
}

} // namespace

const CloudMethod kVertexTriplexMethod{
    MainParameter::Coverage, "coverage", 16.0, 0, runVertexTriplex};

} // namespace lodestone
