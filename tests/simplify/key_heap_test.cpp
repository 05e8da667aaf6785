#include "simplify/collapse/key_heap.h"

#include <gtest/gtest.h>
#include <random>
#include <set>

using namespace lodestone;

TEST(KeyHeap, GivesTheSmallestKeyWhateverWasPushedPoppedAndReplaced) {
    std::mt19937_64 random(3);
    for (const std::size_t size : {1u, 2u, 5u, 6u, 40u, 1000u}) {
        KeyHeap heap;
        std::set<std::uint64_t> expected;
        while (expected.size() < size)
            if (const std::uint64_t key = random(); expected.insert(key).second)
                heap.append(key);
        heap.arrange();
        for (int round = 0; round < 3000; ++round) {
            ASSERT_EQ(heap.empty(), expected.empty());
            const std::uint64_t key = random() >> (round % 3 == 0 ? 8 : 0);
            if (round % 4 == 0 || expected.empty()) {
                if (expected.insert(key).second)
                    heap.push(key);
                continue;
            }
            ASSERT_EQ(heap.top(), *expected.begin());
            if (round % 4 == 1) {
                EXPECT_EQ(heap.pop(), *expected.begin());
                expected.erase(expected.begin());
            } else if (!expected.contains(key)) { // larger or smaller than the rest
                heap.replaceTop(key);
                expected.erase(expected.begin());
                expected.insert(key);
            }
        }
        while (!heap.empty()) {
            EXPECT_EQ(heap.pop(), *expected.begin());
            expected.erase(expected.begin());
        }
        EXPECT_TRUE(expected.empty());
    }
}
