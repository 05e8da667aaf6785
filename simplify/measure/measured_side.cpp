#include "simplify/measure/measured_side.h"

namespace lodestone {

namespace {

Result<MeasuredSide>
measuredSide(const LodView& view, const SurfaceFrame& frame, const JobContext& job) {
    std::vector<SurfacePiece> pieces = surfacePieces(view, frame);
    if (pieces.empty())
        return badInput(view.scene->name +
                        ": no triangle to measure; choose a scene with triangles");
    Result<SurfaceSampler> sampler = SurfaceSampler::build(pieces, job);
    if (!sampler)
        return tl::unexpected(sampler.error());
    Result<ClosestSurface> surface = ClosestSurface::build(pieces, job);
    if (!surface)
        return tl::unexpected(surface.error());
    return MeasuredSide{std::move(pieces), std::move(*sampler), std::move(*surface)};
}

} // namespace

Result<MeasuredPair> measuredPair(const LodView& a,
                                  const LodView& b,
                                  const DistanceOptions& options,
                                  const JobContext& job) {
    if (options.samples < 1)
        return fail(ErrorKind::Usage, "distance: the number of samples must be 1 or more");
    const Result<SurfaceFrame> frame = frameOf(*a.scene);
    if (!frame)
        return tl::unexpected(frame.error());
    Result<MeasuredSide> side_a = measuredSide(a, *frame, job);
    if (!side_a)
        return tl::unexpected(side_a.error());
    Result<MeasuredSide> side_b = measuredSide(b, *frame, job);
    if (!side_b)
        return tl::unexpected(side_b.error());
    return MeasuredPair{std::move(*side_a), std::move(*side_b)};
}

} // namespace lodestone
