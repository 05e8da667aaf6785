#pragma once
// An algorithm whose builds can be held, failed and counted, for tests of lanes and jobs.
#include "simplify/algorithm.h"

#include <atomic>

namespace lodestone::fixtures {

// Position p has (triangles of the scene) - p triangles; geometry is the scene's own.
class FakeSource final : public LodSource {
public:
    FakeSource(ScenePtr scene, ScheduleOptions schedule);

    const ScenePtr& scene() const override { return scene_; }

    std::uint64_t positionCount() const override { return total_ + 1; }

    std::uint64_t trianglesAt(std::uint64_t position) const override { return total_ - position; }

    double errorAt(std::uint64_t position) const override;
    LodShape shapeAt(std::uint64_t position) const override;
    Resolved resolve(const Target& target, const ByteModel& bytes) const override;
    Lod readOut(std::uint64_t position, const Lod* previous) const override;
    std::shared_ptr<const LodSource> rescheduled(const ScheduleOptions& options,
                                                 const ByteModel& bytes) const override;

    std::vector<std::string> notes() const override { return {}; }

    const ScheduleOptions& schedule() const { return schedule_; }

private:
    ScenePtr scene_;
    ScheduleOptions schedule_;
    std::uint64_t total_ = 0;
};

// Reset by FakeAlgorithm's constructor; builds read it while they run.
struct FakeBuilds {
    std::atomic<bool> hold{false}; // builds wait until false or stopped
    std::atomic<bool> fail{false};
    std::atomic<bool> slow_schedule{false}; // seconds_schedule says so
    std::atomic<int> started{0};
    std::atomic<int> finished{0};
    std::atomic<int> stopped{0};
    std::atomic<int> rescheduled{0};
};

FakeBuilds& fakeBuilds();
void resetFakeBuilds();
// A row with one parameter, "strength" 0..10, default 1.
const Algorithm& fakeAlgorithm();
const Algorithm& fakeOneShotAlgorithm(); // the same as one of Family::OneShot

} // namespace lodestone::fixtures
