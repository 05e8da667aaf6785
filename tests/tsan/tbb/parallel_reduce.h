#pragma once
// See fork_join.h.
#include "tests/tsan/tbb/parallel_for.h"

#include <mutex>

namespace tbb {

// Joins in the order of the range, as oneTBB does.
template <class Value, class Result, class Body, class Join>
Result parallel_reduce(const blocked_range<Value>& range,
                       const Result& identity,
                       const Body& body,
                       const Join& join) {
    std::mutex mutex;
    std::vector<std::pair<Value, Result>> partials;
    parallel_for(range, [&](const blocked_range<Value>& part) {
        Result partial = body(part, identity);
        const std::scoped_lock lock(mutex);
        partials.emplace_back(part.begin(), std::move(partial));
    });
    std::ranges::sort(partials, {}, [](const auto& partial) { return partial.first; });
    Result total = identity;
    for (const auto& [begin, partial] : partials)
        total = join(total, partial);
    return total;
}

} // namespace tbb
