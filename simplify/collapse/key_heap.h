#pragma once
// The queue of edge collapses: a heap of four children a node over 64-bit keys that are all
// different, the smallest on top. The smallest of four is found without a branch: which one it is
// cannot be foreseen.
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lodestone {

class KeyHeap {
public:
    bool empty() const { return keys_.empty(); }

    void clear() { keys_.clear(); }

    void append(std::uint64_t key) { keys_.push_back(key); } // before arrange()

    void arrange() {
        for (std::size_t at = keys_.size() / kChildren + 1; at-- > 0;)
            if (at < keys_.size())
                sink(at, keys_[at]);
    }

    void push(std::uint64_t key) {
        keys_.push_back(key);
        rise(keys_.size() - 1, key);
    }

    std::uint64_t top() const { return keys_.front(); } // not empty

    std::uint64_t pop() {
        const std::uint64_t top = keys_.front();
        const std::uint64_t last = keys_.back();
        keys_.pop_back();
        if (!keys_.empty())
            sink(0, last);
        return top;
    }

    // What was on top has another key now, mostly one that is not much larger.
    void replaceTop(std::uint64_t key) {
        std::size_t at = 0;
        for (std::size_t least = leastChild(at); least != 0 && keys_[least] < key;
             least = leastChild(at)) {
            keys_[at] = keys_[least];
            at = least;
        }
        keys_[at] = key;
    }

private:
    static constexpr std::size_t kChildren = 4;

    // 0: there is none.
    std::size_t leastChild(std::size_t at) const {
        const std::uint64_t* const keys = keys_.data();
        const std::size_t count = keys_.size();
        const std::size_t child = kChildren * at + 1;
        if (child >= count)
            return 0;
        if (child + kChildren <= count) {
            const std::size_t a = child + (keys[child + 1] < keys[child] ? 1u : 0u);
            const std::size_t b = child + 2 + (keys[child + 3] < keys[child + 2] ? 1u : 0u);
            return keys[b] < keys[a] ? b : a;
        }
        std::size_t least = child;
        for (std::size_t other = child + 1; other < count; ++other)
            least = keys[other] < keys[least] ? other : least;
        return least;
    }

    // Down to a leaf whatever the key, then up: it came from a leaf and mostly ends near one.
    void sink(std::size_t at, std::uint64_t key) {
        const std::size_t top = at;
        for (std::size_t least = leastChild(at); least != 0; least = leastChild(at)) {
            keys_[at] = keys_[least];
            at = least;
        }
        rise(at, key, top);
    }

    void rise(std::size_t at, std::uint64_t key, std::size_t top = 0) {
        while (at > top) {
            const std::size_t parent = (at - 1) / kChildren;
            if (keys_[parent] < key)
                break;
            keys_[at] = keys_[parent];
            at = parent;
        }
        keys_[at] = key;
    }

    std::vector<std::uint64_t> keys_;
};

} // namespace lodestone
