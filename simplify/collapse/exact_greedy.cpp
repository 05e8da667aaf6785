#include "simplify/collapse/component_mesh.h"

#include <algorithm>
#include <bit>
#include <vector>

namespace lodestone {

namespace {

// A heap of four children a node over 64-bit keys that are all different, the smallest on top. The
// smallest of four is found without a branch: which one it is cannot be foreseen.
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

    std::uint64_t pop() {
        const std::uint64_t top = keys_.front();
        const std::uint64_t last = keys_.back();
        keys_.pop_back();
        if (!keys_.empty())
            sink(0, last);
        return top;
    }

private:
    static constexpr std::size_t kChildren = 4;

    // Down to a leaf whatever the key, then up: it came from a leaf and mostly ends near one.
    void sink(std::size_t at, std::uint64_t key) {
        const std::size_t top = at;
        std::uint64_t* const keys = keys_.data();
        const std::size_t count = keys_.size();
        for (std::size_t child = kChildren * at + 1; child < count; child = kChildren * at + 1) {
            std::size_t least = child;
            if (child + kChildren <= count) {
                const std::size_t a = child + (keys[child + 1] < keys[child] ? 1u : 0u);
                const std::size_t b = child + 2 + (keys[child + 3] < keys[child + 2] ? 1u : 0u);
                least = keys[b] < keys[a] ? b : a;
            } else {
                for (std::size_t other = child + 1; other < count; ++other)
                    least = keys[other] < keys[least] ? other : least;
            }
            keys[at] = keys[least];
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

// A candidate edge, a < b.
struct Candidate {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    std::uint32_t stamp = 0; // sum of both ends' versions when it was costed
};

// Candidates by cost, then by slot: in the order they were costed until slots are used again, the
// same everywhere.
class LazyHeap {
public:
    explicit LazyHeap(ComponentMesh& mesh) : mesh_(mesh) {}

    void fill() {
        heap_.clear();
        slots_.clear();
        free_slots_.clear();
        for (std::uint32_t v = 0; v < mesh_.vertexCount(); ++v)
            addAround(
                v,
                [&](std::uint32_t other) { return other > v; },
                [&](std::uint64_t key) { heap_.append(key); });
        heap_.arrange();
    }

    void pushAround(std::uint32_t v) {
        addAround(
            v, [](std::uint32_t) { return true; }, [&](std::uint64_t key) { heap_.push(key); });
    }

    // The cheapest candidate whose ends have not changed since; false if there is none.
    bool pop(Candidate& out) {
        while (!heap_.empty()) {
            const auto slot = static_cast<std::uint32_t>(heap_.pop());
            out = slots_[slot];
            free_slots_.push_back(slot);
            if (out.stamp == stampOf(out.a, out.b))
                return true;
        }
        return false;
    }

private:
    std::uint32_t stampOf(std::uint32_t a, std::uint32_t b) const {
        return mesh_.version(a) + mesh_.version(b);
    }

    std::uint32_t store(const Candidate& candidate) {
        if (free_slots_.empty()) {
            slots_.push_back(candidate);
            return static_cast<std::uint32_t>(slots_.size() - 1);
        }
        const std::uint32_t slot = free_slots_.back();
        free_slots_.pop_back();
        slots_[slot] = candidate;
        return slot;
    }

    template <class Accept, class Push>
    void addAround(std::uint32_t v, Accept accept, Push push) {
        const ComponentMesh::Spokes spokes = mesh_.costSpokes(v, accept);
        for (std::size_t i = 0; i < spokes.others.size(); ++i) {
            const std::uint32_t a = std::min(v, spokes.others[i]);
            const std::uint32_t b = std::max(v, spokes.others[i]);
            const auto cost = std::bit_cast<std::uint32_t>(spokes.keys[i]);
            push(std::uint64_t{cost} << 32 | store({a, b, stampOf(a, b)}));
        }
    }

    ComponentMesh& mesh_;
    KeyHeap heap_;                          // cost, then slot
    std::vector<Candidate> slots_;          // [slots]
    std::vector<std::uint32_t> free_slots_; // the last freed is used first
};

// Runs one queue until it is empty. Sets `moved` if anything collapsed. False if stopped.
bool drain(ComponentMesh& mesh,
           LazyHeap& heap,
           Strictness strictness,
           const CollapseWatch& watch,
           bool& moved) {
    Candidate candidate;
    std::uint32_t live = mesh.liveFaces();
    for (std::uint32_t round = 1; heap.pop(candidate); ++round) {
        if (round % 1024 == 0 && !watch.goOn(mesh, live))
            return false;
        const auto [a, b, stamp] = candidate;
        if (!mesh.movable(a, b) || !mesh.tryCollapse(a, b, mesh.place(a, b), strictness))
            continue;
        moved = true;
        heap.pushAround(a);
    }
    return watch.goOn(mesh, live);
}

} // namespace

bool collapseExactGreedy(ComponentMesh& mesh, const CollapseWatch& watch) {
    LazyHeap heap(mesh);
    // A rejected edge may become possible once its surroundings have changed: queues are refilled
    // while that helps, and only then is the next liberty taken.
    for (const Strictness strictness :
         {Strictness::Manifold, Strictness::Upright, Strictness::Anything}) {
        bool moved = true;
        while (moved && mesh.liveFaces() > 0) {
            moved = false;
            heap.fill();
            if (!drain(mesh, heap, strictness, watch, moved))
                return false;
        }
    }
    return true;
}

} // namespace lodestone
