// The methods as the source runs them: passes, retriangulation between them.
#include "simplify/pointcloud/cloud_method.h"
#include "simplify/pointcloud/retriangulate.h"

#include <algorithm>

namespace lodestone {

namespace {

void runVertexTriplex(CloudSurface& surface,
                      const Complex& complex,
                      const CloudSettings& settings,
                      const JobContext& job) {
    for (double left = settings.main; left > 0.0 && !job.stopRequested(); left -= 1.0) {
        if (left < settings.main)
            flipToDelaunay(surface, job);
        const Merges merges = vertexTriplex(surface, std::min(left, 1.0), settings.fidelity, job);
        applyMerges(surface, merges, complex, job);
    }
}

template <auto Method>
void runMerging(CloudSurface& surface,
                const Complex& complex,
                const CloudSettings& settings,
                const JobContext& job) {
    if (settings.main > 0.0)
        applyMerges(surface, Method(surface, settings.main, settings.fidelity, job), complex, job);
}

void runFaceAngle(CloudSurface& surface,
                  const Complex&,
                  const CloudSettings& settings,
                  const JobContext& job) {
    if (!(settings.main > 0.0))
        return; // cosines above 1 by rounding are of faces in one plane
    removeFlatVertices(
        surface, {settings.main, settings.area_share, settings.passes, settings.fidelity}, job);
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
    applyMerges(
        surface, sphericalScanning(surface, settings.main, settings.fidelity, job), complex, job);
}

} // namespace

const CloudMethod kVertexTriplexMethod{
    MainParameter::Coverage, "coverage", 8.0, 0, {1.0, 2.5}, runVertexTriplex};
const CloudMethod kFaceAngleMethod{MainParameter::AngleDeg,
                                   "angle",
                                   180.0,
                                   56,
                                   {15.0, 60.0},
                                   runFaceAngle,
                                   "corners stay, and vertices where a border bends"};
const CloudMethod kIntervertexDistanceMethod{
    MainParameter::DistancePct, "distance", 100.0, 0, {1.0, 2.2}, runMerging<intervertexDistance>};
const CloudMethod kSphericalScanningMethod{
    MainParameter::DistancePct, "radius", 100.0, 0, {1.0, 2.2}, runMerging<sphericalScanning>};
const CloudMethod kVertexTriplexDistanceMethod{MainParameter::DistancePct,
                                               "distance",
                                               100.0,
                                               0,
                                               {1.0, 2.2},
                                               runMerging<vertexTriplexDistance>};
const CloudMethod kFaceAngleScanningMethod{
    MainParameter::DistancePct, "radius", 100.0, 0, {1.0, 2.2}, runFaceAngleScanning};

} // namespace lodestone
