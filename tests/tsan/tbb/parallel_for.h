#pragma once
// See fork_join.h.
#include "tests/tsan/tbb/fork_join.h"

#include <tbb/blocked_range.h>
#include <tbb/partitioner.h>

namespace tbb {

template <class Index, class Body>
void parallel_for(Index first, Index last, const Body& body) {
    if (first < last)
        lodestone::tsan::forkJoin(static_cast<std::size_t>(last - first), [&](std::size_t i) {
            body(static_cast<Index>(first + static_cast<Index>(i)));
        });
}

template <class Value, class Body>
void parallel_for(const blocked_range<Value>& range, const Body& body) {
    const std::size_t size = range.empty() ? 0 : range.size();
    const std::size_t parts = lodestone::tsan::partCount(size, range.grainsize());
    const auto at = [&](std::size_t part) {
        return static_cast<Value>(range.begin() + static_cast<Value>(size * part / parts));
    };
    if (size > 0)
        lodestone::tsan::forkJoin(parts, [&](std::size_t part) {
            body(blocked_range<Value>(at(part), at(part + 1), range.grainsize()));
        });
}

template <class Value, class Body>
void parallel_for(const blocked_range<Value>& range, const Body& body, const simple_partitioner&) {
    parallel_for(range, body);
}

} // namespace tbb
