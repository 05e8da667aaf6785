#pragma once
// What a source offers besides if it computes a LOD when it is asked for (Family::OneShot).
#include "scene/job_context.h"
#include "simplify/lod_source.h"

namespace lodestone {

class StoppableSource {
public:
    virtual ~StoppableSource() = default;

    // LodSource::resolve and readOut, that stop within 10 ms where asked to: what they give then is
    // to be dropped. What they have found comes at once when it is asked for again.
    virtual Resolved
    resolveWithin(const Target& target, const ByteModel& bytes, const JobContext& job) const = 0;
    virtual Lod readOutWithin(std::uint64_t position, const JobContext& job) const = 0;
};

} // namespace lodestone
