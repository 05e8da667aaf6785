#include "simplify/wild/virtual_edges.h"

#include "simplify/wild/triangle_distance.h"
#include "simplify/wild/triangle_tree.h"

#include <algorithm>
#include <numeric>
#include <tbb/parallel_for.h>
#include <tuple>

namespace lodestone {

namespace {

struct Candidate {
    std::uint32_t a = 0; // a vertex of a component
    std::uint32_t b = 0; // of another one
    double length = 0.0;
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

    Candidate edge(std::uint32_t a, std::uint32_t b) const {
        return {
            a, b, glm::length(glm::dvec3(complex.positions[a]) - glm::dvec3(complex.positions[b]))};
    }

    // The corner nearest to a point.
    std::uint32_t cornerAt(std::uint32_t face, const glm::dvec3& at) const {
        const Triangle t = triangle(face);
        std::size_t best = 0;
        for (std::size_t k = 1; k < 3; ++k)
            if (glm::length(t[k] - at) < glm::length(t[best] - at))
                best = k;
        return vertex(face, best);
    }

    void offer(std::uint32_t face, std::uint32_t other, std::vector<Candidate>& out) const {
        if (rule == VirtualEdgeRule::Triangles) {
            const Triangle one = triangle(face);
            const Triangle two = triangle(other);
            if (surelyApart(one, two, reach))
                return;
            const TriangleGap gap = triangleGap(one, two);
            if (gap.distance < reach)
                out.push_back(edge(cornerAt(face, gap.at[0]), cornerAt(other, gap.at[1])));
            return;
        }
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t l = 0; l < 3; ++l)
                if (const Candidate found = edge(vertex(face, k), vertex(other, l));
                    found.length < reach)
                    out.push_back(found);
    }
};

// A block at a time, so that the result does not depend on the threads.
std::vector<Candidate> findCandidates(const Finder& finder, const JobContext& job) {
    constexpr std::size_t kBlock = 512; // faces
    const std::size_t faces = finder.complex.faces.size();
    std::vector<std::vector<Candidate>> blocks((faces + kBlock - 1) / kBlock);
    tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t block) {
        const std::size_t end = std::min(faces, (block + 1) * kBlock);
        for (std::size_t f = block * kBlock; f < end && !job.stopRequested(); ++f) {
            const auto face = static_cast<std::uint32_t>(f);
            finder.tree.visitNear(face, finder.reach, [&](std::uint32_t other) {
                finder.offer(face, other, blocks[block]);
            });
        }
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
    std::ranges::stable_sort(edges, {}, &Candidate::length);
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
        double length = 0.0;
        std::uint32_t other = 0;

        bool operator<(const Choice& than) const {
            return std::tie(vertex, component, length, other) <
                   std::tie(than.vertex, than.component, than.length, than.other);
        }
    };

    std::vector<Choice> choices;
    choices.reserve(2 * candidates.size());
    for (const Candidate& edge : candidates) {
        choices.push_back({edge.a, component_of_vertex[edge.b], edge.length, edge.b});
        choices.push_back({edge.b, component_of_vertex[edge.a], edge.length, edge.a});
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
            mutual.push_back({choice.vertex, choice.other, choice.length});
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
    const Finder finder{complex, tree, options.rule, options.epsilon * diagonalOf(complex)};
    const std::vector<Candidate> candidates = findCandidates(finder, job);
    if (job.stopRequested() || candidates.empty())
        return;
    complex.virtual_edges = mutuallyNearest(candidates, component_of_vertex);
    joinComponents(complex, component_of_face, component_of_vertex);
}

} // namespace lodestone
