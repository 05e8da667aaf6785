#pragma once
// Sums over many samples that come out the same on any number of threads.
#include "scene/job_context.h"
#include "scene/result.h"

#include <algorithm>
#include <cstdint>
#include <tbb/parallel_for.h>
#include <vector>

namespace lodestone {

// The context of a part of a job: its progress fills begin..end of the job's.
inline JobContext partOf(const JobContext& job, double begin, double end) {
    JobContext part;
    part.stop = job.stop;
    if (job.progress)
        part.progress = [&job, begin, end](double fraction) {
            job.report(begin + (end - begin) * fraction);
        };
    return part;
}

// Sums of measure_block(begin, end, sums) over [0, count), added up in order.
// Sums: default-constructible, add(const Sums&). Errors: Cancelled.
template <class Sums, class MeasureBlock>
Result<Sums>
sumBlocks(std::uint64_t count, const JobContext& job, const MeasureBlock& measure_block) {
    // Small enough to be cancelled within 10 ms, large enough that a block's points lie together.
    constexpr std::uint64_t kBlockPoints = 256;
    constexpr std::uint64_t kBatchBlocks = 1024; // what is held at a time
    const std::uint64_t block_count = (count + kBlockPoints - 1) / kBlockPoints;
    std::vector<Sums> blocks;
    Sums total;
    for (std::uint64_t first = 0; first < block_count; first += kBatchBlocks) {
        blocks.assign(std::min(kBatchBlocks, block_count - first), Sums{});
        tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t i) {
            const std::uint64_t begin = (first + i) * kBlockPoints;
            if (!job.stopRequested())
                measure_block(begin, std::min(begin + kBlockPoints, count), blocks[i]);
        });
        if (job.stopRequested())
            return cancelled();
        for (const Sums& block : blocks)
            total.add(block);
        job.report(static_cast<double>(first + blocks.size()) / static_cast<double>(block_count));
    }
    return total;
}

} // namespace lodestone
