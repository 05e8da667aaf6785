#include "simplify/wild/virtual_edges.h"

#include "simplify/wild/triangle_distance.h"
#include "simplify/wild/triangle_tree.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <tbb/parallel_for.h>
#include <tuple>

namespace lodestone {

namespace {

struct Candidate {
    std::uint32_t a = 0; // a vertex of a component
    std::uint32_t b = 0; // of another one
    double length2 = 0.0;
};

// The shortest edges seen lately: what is longer than others from both of its ends to the same
// components is neither kept nor does it stand in the way of any, and most near pairs of faces have
// nothing better to offer. Forgetful, as it only spares work.
class ShortestSeen {
public:
    bool beats(std::uint32_t vertex, std::uint32_t component, std::uint32_t other, double length2) {
        const Place& place = placeOf(vertex, component);
        return place.vertex == vertex && place.component == component &&
               (place.length2 < length2 || (place.length2 == length2 && place.other <= other));
    }

    void add(std::uint32_t vertex, std::uint32_t component, std::uint32_t other, double length2) {
        placeOf(vertex, component) = {vertex, component, other, length2};
    }

private:
    struct Place {
        std::uint32_t vertex = kNone;
        std::uint32_t component = kNone;
        std::uint32_t other = kNone;
        double length2 = 0.0;
    };

    Place& placeOf(std::uint32_t vertex, std::uint32_t component) {
        return places_[(vertex + component * 40'503u) % places_.size()];
    }

    std::array<Place, 1024> places_;
};

std::vector<std::uint32_t> componentsOfFaces(const Complex& complex) {
    std::vector<std::uint32_t> of_face(complex.faces.size());
    for (std::size_t c = 0; c < complex.componentCount(); ++c)
        for (std::uint32_t i = complex.component_begin[c]; i < complex.component_begin[c + 1]; ++i)
            of_face[complex.component_faces[i]] = static_cast<std::uint32_t>(c);
    return of_face;
}

double diagonalOf(const Complex& complex) {
    Bounds bounds;
    for (const glm::vec3& p : complex.positions)
        if (complex.bulk.holds(glm::dvec3(p)))
            bounds.add(glm::dvec3(p));
    return bounds.diagonal();
}

struct Finder {
    const Complex& complex;
    const TriangleTree& tree;
    std::span<const std::uint32_t> component_of_vertex;
    VirtualEdgeRule rule;
    double reach;

    std::uint32_t vertex(std::uint32_t face, std::size_t corner) const {
        return complex.wedge_vertex[complex.faces[face][corner]];
    }

    Triangle triangle(std::uint32_t face) const {
        Triangle t;
        for (std::size_t k = 0; k < 3; ++k)
            t[k] = glm::dvec3(complex.positions[vertex(face, k)]);
        return t;
    }

    // The corner nearest to a point.
    static std::size_t cornerAt(const Triangle& t, const glm::dvec3& at) {
        const auto distance2 = [&](std::size_t k) { return glm::dot(t[k] - at, t[k] - at); };
        const std::size_t best = distance2(1) < distance2(0) ? 1 : 0;
        return distance2(2) < distance2(best) ? 2 : best;
    }

    bool beaten(const Candidate& edge, ShortestSeen& seen) const {
        return seen.beats(edge.a, component_of_vertex[edge.b], edge.b, edge.length2) &&
               seen.beats(edge.b, component_of_vertex[edge.a], edge.a, edge.length2);
    }

    void add(const Candidate& edge, ShortestSeen& seen, std::vector<Candidate>& out) const {
        if (beaten(edge, seen))
            return;
        seen.add(edge.a, component_of_vertex[edge.b], edge.b, edge.length2);
        seen.add(edge.b, component_of_vertex[edge.a], edge.a, edge.length2);
        out.push_back(edge);
    }

    void offer(std::uint32_t face,
               std::uint32_t other,
               ShortestSeen& seen,
               std::vector<Candidate>& out) const {
        const Triangle one = triangle(face);
        const Triangle two = triangle(other);
        const auto edge = [&](std::size_t k, std::size_t l) {
            const glm::dvec3 gap = one[k] - two[l];
            return Candidate{vertex(face, k), vertex(other, l), glm::dot(gap, gap)};
        };
        if (rule == VirtualEdgeRule::Triangles) {
            if (const auto gap = triangleGap(one, two, reach))
                add(edge(cornerAt(one, gap->at[0]), cornerAt(two, gap->at[1])), seen, out);
            return;
        }
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t l = 0; l < 3; ++l)
                if (const Candidate near = edge(k, l); near.length2 < reach * reach)
                    add(near, seen, out);
    }
};

// A block at a time, so that the result does not depend on the threads.
std::vector<Candidate> findCandidates(const Finder& finder, const JobContext& job) {
    constexpr std::size_t kBlock = 128; // leaves
    const std::size_t leaves = finder.tree.leafCount();
    std::vector<std::vector<Candidate>> blocks((leaves + kBlock - 1) / kBlock);
    tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t block) {
        const std::size_t end = std::min(leaves, (block + 1) * kBlock);
        ShortestSeen seen;
        for (std::size_t leaf = block * kBlock; leaf < end && !job.stopRequested(); ++leaf)
            finder.tree.visitPairs(
                leaf, finder.reach, [&](std::uint32_t face, std::uint32_t other) {
                    finder.offer(face, other, seen, blocks[block]);
                });
    });
    std::vector<Candidate> all;
    for (const std::vector<Candidate>& block : blocks)
        all.insert(all.end(), block.begin(), block.end());
    return all;
}

// The shortest edges, few at each vertex: in a heap of crossing triangles all are near all others.
std::vector<std::array<std::uint32_t, 2>> shortestOf(std::vector<Candidate> edges,
                                                     std::size_t vertex_count) {
    constexpr std::uint32_t kMostAtVertex = 8;
    std::ranges::stable_sort(edges, {}, &Candidate::length2);
    std::vector<std::uint32_t> taken(vertex_count, 0);
    std::vector<std::array<std::uint32_t, 2>> kept;
    for (const Candidate& edge : edges)
        if (taken[edge.a] < kMostAtVertex && taken[edge.b] < kMostAtVertex) {
            ++taken[edge.a];
            ++taken[edge.b];
            kept.push_back({edge.a, edge.b});
        }
    return kept;
}

// Keeps the pairs in which each end is the other's nearest in that component.
std::vector<std::array<std::uint32_t, 2>>
mutuallyNearest(std::span<const Candidate> candidates,
                std::span<const std::uint32_t> component_of_vertex) {
    struct Choice {
        std::uint32_t vertex = 0;
        std::uint32_t component = 0; // the other one
        double length2 = 0.0;
        std::uint32_t other = 0;

        bool operator<(const Choice& than) const {
            return std::tie(vertex, component, length2, other) <
                   std::tie(than.vertex, than.component, than.length2, than.other);
        }
    };

    std::vector<Choice> choices;
    choices.reserve(2 * candidates.size());
    for (const Candidate& edge : candidates) {
        choices.push_back({edge.a, component_of_vertex[edge.b], edge.length2, edge.b});
        choices.push_back({edge.b, component_of_vertex[edge.a], edge.length2, edge.a});
    }
    std::ranges::sort(choices, std::less{});
    const auto same = [](const Choice& a, const Choice& b) {
        return a.vertex == b.vertex && a.component == b.component;
    };
    choices.erase(std::unique(choices.begin(), choices.end(), same), choices.end());
    const auto nearest = [&](std::uint32_t vertex, std::uint32_t component) {
        const auto found =
            std::lower_bound(choices.begin(), choices.end(), Choice{vertex, component, -1.0, 0});
        return found->other;
    };
    std::vector<Candidate> mutual;
    for (const Choice& choice : choices)
        if (choice.vertex < choice.other &&
            nearest(choice.other, component_of_vertex[choice.vertex]) == choice.vertex)
            mutual.push_back({choice.vertex, choice.other, choice.length2});
    return shortestOf(std::move(mutual), component_of_vertex.size());
}

std::uint32_t rootOf(std::vector<std::uint32_t>& parent, std::uint32_t component) {
    while (parent[component] != component)
        component = parent[component] = parent[parent[component]];
    return component;
}

// Components joined by edges become one; their order stays that of their first faces.
void joinComponents(Complex& complex,
                    std::span<const std::uint32_t> component_of_face,
                    std::span<const std::uint32_t> component_of_vertex) {
    std::vector<std::uint32_t> parent(complex.componentCount());
    std::iota(parent.begin(), parent.end(), 0u);
    for (const auto& [a, b] : complex.virtual_edges) {
        const std::uint32_t x = rootOf(parent, component_of_vertex[a]);
        const std::uint32_t y = rootOf(parent, component_of_vertex[b]);
        parent[std::max(x, y)] = std::min(x, y);
    }
    std::vector<std::uint32_t> joined(parent.size()); // new number
    std::uint32_t count = 0;
    for (std::uint32_t c = 0; c < parent.size(); ++c)
        joined[c] = rootOf(parent, c) == c ? count++ : joined[rootOf(parent, c)];
    // Counting sorts: faces and edges by joined component.
    const auto sort_into = [&](auto& begin, std::size_t items, auto component, auto place) {
        begin.assign(count + 1, 0);
        for (std::size_t i = 0; i < items; ++i)
            ++begin[component(i) + 1];
        std::partial_sum(begin.begin(), begin.end(), begin.begin());
        std::vector<std::uint32_t> at(begin.begin(), begin.end() - 1);
        for (std::size_t i = 0; i < items; ++i)
            place(at[component(i)]++, i);
    };
    sort_into(
        complex.component_begin,
        complex.faces.size(),
        [&](std::size_t f) { return joined[component_of_face[f]]; },
        [&](std::uint32_t to, std::size_t f) {
            complex.component_faces[to] = static_cast<std::uint32_t>(f);
        });
    const std::vector<std::array<std::uint32_t, 2>> edges = complex.virtual_edges;
    sort_into(
        complex.virtual_begin,
        edges.size(),
        [&](std::size_t e) { return joined[component_of_vertex[edges[e][0]]]; },
        [&](std::uint32_t to, std::size_t e) { complex.virtual_edges[to] = edges[e]; });
}

} // namespace

void addVirtualEdges(Complex& complex, const VirtualEdgeOptions& options, const JobContext& job) {
    if (!(options.epsilon > 0.0) || complex.componentCount() < 2)
        return;
    const std::vector<std::uint32_t> component_of_face = componentsOfFaces(complex);
    std::vector<std::uint32_t> component_of_vertex(complex.positions.size(), kNone);
    for (std::size_t f = 0; f < complex.faces.size(); ++f)
        for (const std::uint32_t wedge : complex.faces[f])
            component_of_vertex[complex.wedge_vertex[wedge]] = component_of_face[f];
    const TriangleTree tree(complex, component_of_face);
    const Finder finder{
        complex, tree, component_of_vertex, options.rule, options.epsilon * diagonalOf(complex)};
    const std::vector<Candidate> candidates = findCandidates(finder, job);
    if (job.stopRequested() || candidates.empty())
        return;
    complex.virtual_edges = mutuallyNearest(candidates, component_of_vertex);
    joinComponents(complex, component_of_face, component_of_vertex);
}

} // namespace lodestone
