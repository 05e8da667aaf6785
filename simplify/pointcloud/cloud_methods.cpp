// The methods as the source runs them: passes, retriangulation after each.
#include "simplify/pointcloud/cloud_method.h"
#include "simplify/pointcloud/retriangulate.h"

#include <algorithm>

namespace lodestone {

namespace {

void mergeAndFlip(CloudSurface& surface,
                  const Complex& complex,
                  const Merges& merges,
                  const JobContext& job) {
    if (job.stopRequested())
        return;
    applyMerges(surface, merges, complex);
    flipToDelaunay(surface, job);
}

void runVertexTriplex(CloudSurface& surface,
                      const Complex& complex,
                      const CloudSettings& settings,
                      const JobContext& job) {
    for (double left = settings.main; left > 0.0 && !job.stopRequested(); left -= 1.0) {
        const Merges merges = vertexTriplex(surface, std::min(left, 1.0), settings.fidelity, job);
        mergeAndFlip(surface, complex, merges, job);
    }
}

template <auto Method>
void runMerging(CloudSurface& surface,
                const Complex& complex,
                const CloudSettings& settings,
                const JobContext& job) {
    if (settings.main > 0.0)
        mergeAndFlip(surface, complex, Method(surface, settings.main, settings.fidelity, job), job);
}

void runFaceAngle(CloudSurface& surface,
                  const Complex&,
                  const CloudSettings& settings,
                  const JobContext& job) {
    removeFlatVertices(
        surface, {settings.main, settings.area_share, settings.passes, settings.fidelity}, job);
    flipToDelaunay(surface, job);
}

void runFaceAngleScanning(CloudSurface& surface,
                          const Complex& complex,
                          const CloudSettings& settings,
                          const JobContext& job) {
    if (!(settings.main > 0.0))
        return;
    removeFlatVertices(
        surface,
        {settings.angle_deg, settings.area_share, settings.passes, settings.fidelity},
        job);
    mergeAndFlip(
        surface, complex, sphericalScanning(surface, settings.main, settings.fidelity, job), job);
}

} // namespace

const CloudMethod kVertexTriplexMethod{
    MainParameter::Coverage, "coverage", 8.0, 0, runVertexTriplex};
const CloudMethod kFaceAngleMethod{MainParameter::AngleDeg, "angle", 180.0, 56, runFaceAngle};
const CloudMethod kIntervertexDistanceMethod{
    MainParameter::DistancePct, "distance", 100.0, 0, runMerging<intervertexDistance>};
const CloudMethod kSphericalScanningMethod{
    MainParameter::DistancePct, "radius", 100.0, 0, runMerging<sphericalScanning>};
const CloudMethod kVertexTriplexDistanceMethod{
    MainParameter::DistancePct, "distance", 100.0, 0, runMerging<vertexTriplexDistance>};
const CloudMethod kFaceAngleScanningMethod{
    MainParameter::DistancePct, "radius", 100.0, 0, runFaceAngleScanning};

} // namespace lodestone
