#include "simplify/bake/successive_map.h"

#include "simplify/bake/closest_point.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace lodestone {

namespace {

// What happens at each step, up to a last one: ids grouped by step.
struct ByStep {
    std::vector<std::uint32_t> begin; // [steps + 1] of step s at s - 1
    std::vector<std::uint32_t> ids;

    std::span<const std::uint32_t> at(std::uint32_t step) const {
        return {ids.data() + begin[step - 1], begin[step] - begin[step - 1]};
    }
};

ByStep groupBySteps(std::span<const std::uint32_t> step_of, std::uint32_t last) {
    ByStep groups;
    groups.begin.assign(last + 2, 0);
    const auto takes = [&](std::uint32_t step) { return step >= 1 && step <= last; };
    for (const std::uint32_t step : step_of)
        if (takes(step))
            ++groups.begin[step];
    std::partial_sum(groups.begin.begin(), groups.begin.end(), groups.begin.begin());
    groups.ids.resize(groups.begin.back());
    std::vector<std::uint32_t> at(groups.begin.begin(), groups.begin.end() - 1);
    for (std::uint32_t i = 0; i < step_of.size(); ++i)
        if (takes(step_of[i]))
            groups.ids[at[step_of[i] - 1]++] = i;
    return groups;
}

glm::vec3 centreOf(const std::array<glm::vec3, 3>& t) {
    return (t[0] + t[1] + t[2]) * (1.0f / 3.0f);
}

// Whether a point lies over the inside of a triangle that looks as the normal does.
bool liesOver(const glm::vec3& point, const std::array<glm::vec3, 3>& t, const glm::vec3& normal) {
    const glm::vec3 ab = t[1] - t[0];
    const glm::vec3 ac = t[2] - t[0];
    const glm::vec3 ap = point - t[0];
    const glm::vec3 across = glm::cross(ab, ac);
    const float b = glm::dot(glm::cross(ap, ac), across);
    const float c = glm::dot(glm::cross(ab, ap), across);
    return glm::dot(across, normal) > 0.0f && b > 0.0f && c > 0.0f &&
           b + c < glm::dot(across, across);
}

} // namespace

// Walks the sequence forward once and notes the triangles around every edge before it collapses.
struct SuccessiveMap::Replay {
    SuccessiveMap& map;
    const CollapseSequence& sequence;
    std::vector<std::vector<std::uint32_t>> faces_of; // [wedges] with a corner on it
    std::vector<std::uint32_t> seen;                  // [faces] last step that met it
    std::vector<std::uint32_t> met;
    std::vector<std::pair<std::uint32_t, Split>> outlived; // by faces

    void meet(std::uint32_t wedge, std::uint32_t step) {
        std::vector<std::uint32_t>& faces = faces_of[wedge];
        std::erase_if(faces, [&](std::uint32_t f) { return sequence.face_death[f] < step; });
        for (const std::uint32_t f : faces)
            if (seen[f] != step) {
                seen[f] = step;
                met.push_back(f);
            }
    }

    void note(std::uint32_t step) {
        const bool outlives = std::ranges::any_of(
            met, [&](std::uint32_t f) { return sequence.face_death[f] > step; });
        if (!outlives) // nothing left that a point could lie on
            return;
        for (const std::uint32_t f : met) {
            Candidate candidate{f, 0.0f, {}};
            for (std::size_t k = 0; k < 3; ++k)
                candidate.corners[k] = map.positions_[map.wedges_[f][k]];
            const glm::vec3 centre = centreOf(candidate.corners);
            for (const glm::vec3& corner : candidate.corners)
                candidate.radius = std::max(candidate.radius, glm::length(corner - centre));
            if (sequence.face_death[f] > step)
                outlived.push_back({f, {step, map.candidates_.size()}});
            map.candidates_.push_back(candidate);
        }
    }

    void rename(std::uint32_t wedge, std::uint32_t step) {
        const std::uint32_t parent = sequence.wedge_parent[wedge];
        if (parent == kNone)
            return;
        for (const std::uint32_t f : faces_of[wedge])
            if (sequence.face_death[f] >= step) {
                std::ranges::replace(map.wedges_[f], wedge, parent);
                faces_of[parent].push_back(f);
            }
        faces_of[wedge] = {};
    }

    // Splits of a surface that is much finer than the last step need not be replayed: they move a
    // point by little, and the search at the end finds that.
    std::uint32_t firstNoted(std::uint32_t last) const {
        // Colour errors of textured models at 1 %: no more than 2 % above those of all splits; with
        // 4, up to 7 %.
        constexpr std::uint64_t kFiner = 16; // times as many faces
        const auto faces_at = [&](std::uint32_t step) {
            std::uint64_t faces = 0;
            for (const auto& counts : sequence.counts)
                faces += counts.faces[step];
            return faces;
        };
        std::uint32_t low = 0;
        std::uint32_t high = last;
        while (low < high) {
            const std::uint32_t middle = low + (high - low) / 2;
            if (faces_at(middle) > kFiner * faces_at(last))
                low = middle + 1;
            else
                high = middle;
        }
        return low;
    }

    void run(std::uint32_t last, const JobContext& job) {
        const ByStep deaths = groupBySteps(sequence.wedge_death, last);
        const ByStep versions = groupBySteps(sequence.version_step, last);
        std::vector<std::uint32_t> wedge_of(sequence.version_step.size());
        for (std::uint32_t w = 0; w + 1 < sequence.version_begin.size(); ++w)
            for (std::uint32_t v = sequence.version_begin[w]; v < sequence.version_begin[w + 1];
                 ++v)
                wedge_of[v] = w;
        constexpr std::size_t kRing = 12; // faces around an edge, and some more
        const std::uint32_t first = firstNoted(last);
        map.candidates_.reserve(kRing * (last - first));
        map.candidate_begin_.assign(1, 0);
        for (std::uint32_t step = 1; step <= last; ++step) {
            if (step % 1024 == 0 && job.stopRequested())
                return;
            met.clear();
            if (step > first) {
                for (const std::uint32_t wedge : deaths.at(step))
                    meet(wedge, step);
                for (const std::uint32_t version : versions.at(step))
                    meet(wedge_of[version], step);
                note(step);
            }
            map.candidate_begin_.push_back(map.candidates_.size());
            for (const std::uint32_t wedge : deaths.at(step))
                rename(wedge, step);
            for (const std::uint32_t version : versions.at(step))
                map.positions_[wedge_of[version]] = sequence.version_position[version];
        }
    }
};

SuccessiveMap::SuccessiveMap(const CollapseSequence& sequence,
                             const Submesh& submesh,
                             std::uint32_t step,
                             const JobContext& job)
    : sequence_(sequence), wedges_(sequence.complex.faces) {
    const Complex& complex = sequence.complex;
    originals_.resize(complex.wedge_source.size());
    for (std::size_t p = 0; p + 1 < complex.wedge_begin.size(); ++p)
        for (std::uint32_t w = complex.wedge_begin[p]; w < complex.wedge_begin[p + 1]; ++w)
            originals_[w] = submesh.primitives[p].geometry->positions[complex.wedge_source[w]];
    positions_ = originals_;
    Replay replay{*this, sequence, {}, {}, {}, {}};
    replay.faces_of.resize(originals_.size());
    for (std::vector<std::uint32_t>& faces : replay.faces_of)
        faces.reserve(8); // most vertices have six
    for (std::uint32_t f = 0; f < complex.faces.size(); ++f)
        for (const std::uint32_t wedge : complex.faces[f])
            replay.faces_of[wedge].push_back(f);
    replay.seen.assign(complex.faces.size(), 0);
    replay.run(step, job);
    nearest_.emplace(complex, originals_);
    split_begin_.assign(complex.faces.size() + 1, 0);
    for (const auto& [face, at] : replay.outlived)
        ++split_begin_[face + 1];
    std::partial_sum(split_begin_.begin(), split_begin_.end(), split_begin_.begin());
    splits_.resize(replay.outlived.size());
    std::vector<std::size_t> to(split_begin_.begin(), split_begin_.end() - 1);
    for (const auto& [face, at] : replay.outlived)
        splits_[to[face]++] = at;
    alive_begin_.push_back(0);
    for (std::size_t p = 0; p + 1 < complex.face_begin.size(); ++p) {
        for (std::uint32_t f = complex.face_begin[p]; f < complex.face_begin[p + 1]; ++f)
            if (sequence.face_death[f] > step)
                alive_.push_back(f);
        alive_begin_.push_back(static_cast<std::uint32_t>(alive_.size()));
    }
}

std::array<glm::vec3, 3> SuccessiveMap::triangle(std::uint32_t face) const {
    const auto& wedges = wedges_[face];
    return {positions_[wedges[0]], positions_[wedges[1]], positions_[wedges[2]]};
}

SuccessiveMap::Hit
SuccessiveMap::trace(std::uint32_t face, const glm::vec3& point, const glm::vec3& normal) const {
    constexpr float kOtherSide = 1e-6f; // of the squared size: decides between coincident faces
    std::uint32_t before = kNone;       // only splits of earlier steps are left
    for (;;) {
        const auto begin = splits_.begin() + static_cast<std::ptrdiff_t>(split_begin_[face]);
        const auto end = splits_.begin() + static_cast<std::ptrdiff_t>(split_begin_[face + 1]);
        auto after = std::ranges::lower_bound(begin, end, before, {}, &Split::step);
        // Nothing of the ring is nearer, unless it is folded: two of three splits end here.
        while (after != begin && liesOver(point, candidates_[(after - 1)->own].corners, normal))
            --after;
        if (after == begin)
            break;
        before = (after - 1)->step;
        const auto distance2 = [&](const Candidate& candidate) {
            const auto& c = candidate.corners;
            const glm::vec3 off = point - blended(c, closestOn(point, c));
            const bool away = glm::dot(glm::cross(c[1] - c[0], c[2] - c[0]), normal) < 0.0f;
            return glm::dot(off, off) +
                   (away ? kOtherSide * candidate.radius * candidate.radius : 0.0f);
        };
        float best2 = distance2(candidates_[(after - 1)->own]);
        float best = std::sqrt(best2);
        for (std::size_t i = candidate_begin_[before - 1]; i < candidate_begin_[before]; ++i) {
            const Candidate& candidate = candidates_[i];
            const glm::vec3 to_centre = point - centreOf(candidate.corners);
            const float reach = candidate.radius + best;
            if (glm::dot(to_centre, to_centre) >= reach * reach)
                continue;
            const float found2 = distance2(candidate);
            if (found2 < best2) {
                best2 = found2;
                best = std::sqrt(best2);
                face = candidate.face;
            }
        }
    }
    face = nearest_->closest({point, normal, face});
    const auto& corners = sequence_.complex.faces[face];
    return {
        face,
        closestOn(point, {originals_[corners[0]], originals_[corners[1]], originals_[corners[2]]})};
}

} // namespace lodestone
