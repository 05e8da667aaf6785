#include "tests/app/fake_algorithm.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

namespace lodestone::fixtures {

FakeSource::FakeSource(ScenePtr scene, ScheduleOptions schedule)
    : scene_(std::move(scene)), schedule_(std::move(schedule)),
      total_(countScene(*scene_).triangles) {}

double FakeSource::errorAt(std::uint64_t position) const {
    return 0.5 * static_cast<double>(position);
}

LodShape FakeSource::shapeAt(std::uint64_t position) const {
    return shapeOf(*scene_, readOut(position, nullptr));
}

Resolved FakeSource::resolve(const Target& target, const ByteModel&) const {
    double triangles = target.value;
    if (target.kind == Target::Kind::Ratio)
        triangles = target.value * static_cast<double>(total_);
    const double clamped = std::clamp(std::floor(triangles), 0.0, static_cast<double>(total_));
    return {total_ - static_cast<std::uint64_t>(clamped), true, {}};
}

Lod FakeSource::readOut(std::uint64_t position, const Lod*) const {
    Lod lod = fullLod(*scene_);
    lod.triangles = total_ - position;
    lod.position = position;
    return lod;
}

std::shared_ptr<const LodSource> FakeSource::rescheduled(const ScheduleOptions& options,
                                                         const ByteModel&) const {
    ++fakeBuilds().rescheduled;
    auto other = std::make_shared<FakeSource>(scene_, options);
    other->seconds_schedule = seconds_schedule;
    return other;
}

FakeBuilds& fakeBuilds() {
    static FakeBuilds builds;
    return builds;
}

void resetFakeBuilds() {
    FakeBuilds& builds = fakeBuilds();
    builds.hold = false;
    builds.fail = false;
    builds.slow_schedule = false;
    builds.started = 0;
    builds.finished = 0;
    builds.stopped = 0;
    builds.rescheduled = 0;
}

namespace {

Result<LodSourcePtr> prepareFake(const ScenePtr& scene,
                                 const ParameterValues&,
                                 const ScheduleOptions& schedule,
                                 const JobContext& job) {
    FakeBuilds& builds = fakeBuilds();
    ++builds.started;
    job.report(0.5);
    while (builds.hold) {
        if (job.stopRequested()) {
            ++builds.stopped;
            return cancelled();
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    if (builds.fail)
        return fail(ErrorKind::Failed, "fake: told to fail");
    auto source = std::make_shared<FakeSource>(scene, schedule);
    source->seconds_schedule = builds.slow_schedule ? 1.0 : 0.0;
    ++builds.finished;
    return LodSourcePtr(std::move(source));
}

Algorithm makeFakeAlgorithm() {
    Algorithm algorithm;
    algorithm.id = "fake";
    algorithm.name = "Fake";
    algorithm.short_name = "Fake";
    ParameterInfo strength;
    strength.id = "strength";
    strength.label = "Strength";
    strength.maximum = 10.0;
    strength.fallback = 1.0;
    algorithm.parameters.push_back(strength);
    algorithm.prepare = prepareFake;
    return algorithm;
}

} // namespace

const Algorithm& fakeAlgorithm() {
    static const Algorithm algorithm = makeFakeAlgorithm();
    return algorithm;
}

const Algorithm& fakeOneShotAlgorithm() {
    static const Algorithm algorithm = [] {
        Algorithm made = makeFakeAlgorithm();
        made.family = Family::OneShot;
        return made;
    }();
    return algorithm;
}

} // namespace lodestone::fixtures
