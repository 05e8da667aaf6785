#pragma once
// The groups of rows. Each adds its rows to the table under a heading that is already there.
// Errors: those of importing, simplifying and measuring.
#include "bench/inputs.h"
#include "bench/table.h"
#include "simplify/algorithm.h"
#include "simplify/lod_source.h"

namespace lodestone::bench {

struct Bench {
    Inputs& inputs;
    Table table;
    int rounds = 5; // of things timed in turns
};

// What an early sketch of this design reached on a scene (seconds for the whole sequence, errors at
// 20 % of the triangles). Its machine is known by what meshoptimizer took there.
struct Sketch {
    double seconds = 0.0;
    double triangles = 0.0;        // that were simplified
    double anchor_seconds = 0.0;   // meshoptimizer there, to 20 % of the mesh used here as anchor
    std::uint64_t unique_left = 0; // at 20 %
    std::string hausdorff;         // % of the diagonal, as it was printed
    std::string mean;
};

// Whether a scene is the one that the sketch had; only then its errors are a target.
enum class SketchInput : std::uint8_t { Same, Another };

// meshoptimizer's seconds in the sketch's run.
constexpr double kSketchBunnySeconds = 0.028;
constexpr double kSketchSphereSeconds = 0.50;

// --- one mesh against meshoptimizer

struct AloneTargets {
    double time_ratio = 0.0;
    double mean_ratio = 0.0;
    std::optional<double> maximum_ratio;
    Sketch sketch;
};

AloneTargets bunnyTargets();
AloneTargets sphereTargets();
Result<void>
addAloneRows(Bench& bench, const ScenePtr& scene, const AloneTargets& targets, SketchInput input);

// --- instanced scenes: IAS against Quadric on the expansion

struct InstancedTargets {
    double speedup = 0.0; // of IAS over Quadric on the expanded scene
    Sketch by_triangle;
    Sketch by_cost;
    std::optional<Sketch> expanded;
};

InstancedTargets mapleTargets();
InstancedTargets villageTargets();
Result<void> addInstancedRows(Bench& bench,
                              const ScenePtr& scene,
                              const InstancedTargets& targets,
                              SketchInput input);

// IAS against each mesh alone, at equal instanced triangles.
Result<void> addEqualRows(Bench& bench, const ScenePtr& scene);

// Leaves that edge collapse may not touch.
Result<void> addCardRows(Bench& bench, const ScenePtr& scene);

// --- in the program

Result<void> addReadOutRows(Bench& bench);  // after a slider has moved
Result<void> addFileRows(Bench& bench);     // sizes, import, another ordering
Result<void> addDistanceRows(Bench& bench); // how fast it is measured
Result<void> addMemoryRows(Bench& bench);   // peak of a process of its own

// What that process does; prints its peak in bytes. Returns its exit code.
int runMemoryChild();

// --- what they share

// What meshoptimizer's simplify and the sketch look at: positions. Attributes are carried along.
ParameterValues positionsAlone();

// expanded: a scene of which every submesh is drawn once. Whole sequence and schedule.
Result<LodSourcePtr> prepareQuadric(const ScenePtr& expanded, const ParameterValues& values);
Result<LodSourcePtr>
prepareIas(const ScenePtr& scene, const ParameterValues& values, Ordering ordering);

// meshoptimizer to 20 % of a scene of one mesh, equal positions welded beforehand.
Work meshoptimizerWork(const ScenePtr& scene);

// The Stanford bunny, our own without the models: what small things are timed against.
Result<ScenePtr> anchorBunny(Inputs& inputs);

// One row: seconds per simplified triangle over the anchor's seconds, against the sketch's.
// seconds, anchor_seconds: [rounds]
void addSketchTime(Table& table,
                   const Sketch& sketch,
                   std::uint64_t triangles,
                   std::span<const std::vector<double>> seconds_and_anchor);

// One row: what it costs to let attributes count, as they do by default. [rounds] each
void addAttributeTime(Table& table,
                      const std::vector<double>& by_default,
                      const std::vector<double>& positions_alone);

// Rows: triangles left, maximum and mean at 20 %, beside the sketch's. Returns that LOD.
Result<Lod>
addSketchQuality(Table& table, const LodSource& source, const Sketch& sketch, SketchInput input);

} // namespace lodestone::bench
