#pragma once
// Stand-ins for oneTBB's loops in builds with the thread sanitizer. The packaged library is not
// instrumented: the sanitizer cannot see that a loop's end waits for its bodies, and reports every
// loop. Plain threads show it the same parallelism, so what it still reports is a race of ours.
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace lodestone::tsan {

inline constexpr std::size_t kThreadCount = 4;

// Calls body(i) for i < count from several threads; returns when all have. Nested calls are serial.
// Taking an index orders nothing between the threads: races between bodies stay visible.
template <class Body>
void forkJoin(std::size_t count, const Body& body) {
    static thread_local bool is_nested = false;
    if (is_nested || count < 2) {
        for (std::size_t i = 0; i < count; ++i)
            body(i);
        return;
    }
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
        is_nested = true;
        for (std::size_t i = 0; (i = next.fetch_add(1, std::memory_order_relaxed)) < count;)
            body(i);
    };
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < std::min(count, kThreadCount); ++i)
        threads.emplace_back(work);
}

// The parts that a range of `size` elements is cut into, no smaller than grain_size.
inline std::size_t partCount(std::size_t size, std::size_t grain_size) {
    return std::clamp<std::size_t>(size / std::max<std::size_t>(1, grain_size), 1, 64);
}

} // namespace lodestone::tsan
