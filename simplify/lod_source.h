#pragma once
// What a lane holds once the slow part is done: any LOD, at once.
#include "scene/export.h"
#include "scene/job_context.h"
#include "scene/lod.h"
#include "scene/result.h"
#include "simplify/bake/bake_options.h"
#include "simplify/bake/baked_scene.h"
#include "simplify/target.h"

namespace lodestone {

struct ScheduleOptions {
    Ordering ordering = Ordering::Triangle;
    std::vector<double> importance; // [submeshes] cost factor, 0.1..10; empty: 1
    std::vector<bool> locked;       // [submeshes] never touched; empty: none
};

struct Resolved {
    std::uint64_t position = 0;
    bool met = true;
    std::string note; // why the target was missed; empty if met
};

// Immutable and thread-safe. Position 0 is the full scene, rising positions are coarser, every
// position is a prefix of one order of steps, so LODs are nested and both directions are equal.
class LodSource {
public:
    virtual ~LodSource() = default;

    // The scene whose submeshes the LODs replace: the input, or its expansion (Quadric).
    virtual const ScenePtr& scene() const = 0;
    virtual std::uint64_t positionCount() const = 0;                     // >= 1
    virtual std::uint64_t trianglesAt(std::uint64_t position) const = 0; // O(1) or O(log)
    virtual double errorAt(std::uint64_t position) const = 0;   // estimate, % of the diagonal
    virtual LodShape shapeAt(std::uint64_t position) const = 0; // O(submeshes * log steps)
    // bytes: only used for Target::Kind::Bytes; must be made for scene().
    virtual Resolved resolve(const Target& target, const ByteModel& bytes) const = 0;
    // previous: a LOD of this source or nullptr; submeshes at the same step share its geometry.
    virtual Lod readOut(std::uint64_t position, const Lod* previous) const = 0;

    // resolve() and readOut() that stop within 10 ms where asked to: what they give then is to be
    // dropped. Sources that answer within a frame do not look.
    virtual Resolved
    resolveWithin(const Target& target, const ByteModel& bytes, const JobContext& /*job*/) const {
        return resolve(target, bytes);
    }

    virtual Lod
    readOutWithin(std::uint64_t position, const Lod* previous, const JobContext& /*job*/) const {
        return readOut(position, previous);
    }

    // Same sequences, another order: milliseconds. bytes as in resolve.
    virtual std::shared_ptr<const LodSource> rescheduled(const ScheduleOptions& options,
                                                         const ByteModel& bytes) const = 0;
    virtual std::vector<std::string> notes() const = 0;

    // A LOD with textures of its own. lod: read out from this source. Slow: seconds.
    // Errors: Usage if this source cannot, or an atlas is too small; Cancelled.
    virtual Result<BakedScene> transferred(const Lod& /*lod*/,
                                           const BakeOptions& /*options*/,
                                           const JobContext& /*job*/) const {
        return fail(ErrorKind::Usage, "this algorithm cannot transfer textures");
    }

    // Seconds of wall time that each stage took.
    double seconds_sequence = 0.0;
    double seconds_schedule = 0.0;
};

using LodSourcePtr = std::shared_ptr<const LodSource>;

} // namespace lodestone
