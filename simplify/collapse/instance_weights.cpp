#include "simplify/collapse/instance_weights.h"

#include "simplify/stretch.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

namespace lodestone {

namespace {

constexpr std::size_t kMaxGroups = 64;
constexpr double kSame = 1e-6; // relative difference of Gram matrices that count as equal
constexpr int kTableSide = 24; // directions along a cube face's side

glm::dmat3 cofactor(const glm::dmat3& m) {
    return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

double traceOf(const glm::dmat3& m) {
    return m[0][0] + m[1][1] + m[2][2];
}

double squared(double value) {
    return value * value;
}

bool isSimilarity(const glm::dmat3& gram) {
    const double s2 = traceOf(gram) / 3.0;
    for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r)
            if (std::abs(gram[c][r] - (c == r ? s2 : 0.0)) > kSame * s2)
                return false;
    return true;
}

// Equal matrices within kSame get equal keys but where a rounding border parts them, which only
// costs one group more.
std::array<std::int64_t, 7> keyOf(const glm::dmat3& gram) {
    const double trace = traceOf(gram);
    const auto rounded = [&](double value) {
        return static_cast<std::int64_t>(std::llround(value / (trace * kSame)));
    };
    return {static_cast<std::int64_t>(std::llround(std::log(trace) / kSame)),
            rounded(gram[0][0]),
            rounded(gram[1][1]),
            rounded(gram[2][2]),
            rounded(gram[0][1]),
            rounded(gram[0][2]),
            rounded(gram[1][2])};
}

// Cell coordinates of a direction and its opposite: they weigh the same, so three cube faces do.
struct TableCell {
    int face = 0;
    double u = 0.0; // 0..1
    double v = 0.0;
};

// The planes of sum (e x p)(e x p)^T over the pulls p, given S = sum p p^T: at most two, along the
// principal directions across the edge.
void splitPull(const glm::dvec3& edge,
               const glm::dmat3& pull,
               std::vector<InstanceWeights::Plane>& out) {
    const glm::dvec3 size = glm::abs(edge);
    const glm::dvec3 aside = size.x <= size.y && size.x <= size.z ? glm::dvec3(1.0, 0.0, 0.0)
                             : size.y <= size.z                   ? glm::dvec3(0.0, 1.0, 0.0)
                                                                  : glm::dvec3(0.0, 0.0, 1.0);
    const glm::dvec3 u = glm::normalize(glm::cross(edge, aside));
    const glm::dvec3 v = glm::normalize(glm::cross(edge, u));
    const glm::dvec3 a = glm::cross(u, edge);
    const glm::dvec3 b = glm::cross(v, edge);
    const double uu = glm::dot(a, pull * a);
    const double uv = glm::dot(a, pull * b);
    const double vv = glm::dot(b, pull * b);
    const double angle = 0.5 * std::atan2(2.0 * uv, uu - vv);
    const double half_gap = std::hypot(0.5 * (uu - vv), uv);
    const double mean = 0.5 * (uu + vv);
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    if (mean + half_gap > 0.0)
        out.push_back({c * u + s * v, mean + half_gap});
    if (mean - half_gap > 1e-12 * mean)
        out.push_back({c * v - s * u, mean - half_gap});
}

std::size_t slotOf(int face, int x, int y) {
    constexpr std::size_t kSide{kTableSide};
    return (static_cast<std::size_t>(face) * kSide + static_cast<std::size_t>(y)) * kSide +
           static_cast<std::size_t>(x);
}

TableCell cellOf(const glm::dvec3& n) {
    int axis = 0;
    for (int i = 1; i < 3; ++i)
        if (std::abs(n[i]) > std::abs(n[axis]))
            axis = i;
    const double major = n[axis];
    return {axis, 0.5 + 0.5 * n[(axis + 1) % 3] / major, 0.5 + 0.5 * n[(axis + 2) % 3] / major};
}

} // namespace

InstanceWeights::InstanceWeights() {
    const glm::dmat3 identity(1.0);
    *this = InstanceWeights(std::span(&identity, 1));
}

InstanceWeights::InstanceWeights(std::span<const glm::dmat3> linear_parts) {
    double sum4 = 0.0; // of similarities
    double sum3 = 0.0;
    double similar_count = 0.0;
    max_stretch_ = 0.0;
    std::map<std::array<std::int64_t, 7>, Group> distinct;
    for (const glm::dmat3& linear : linear_parts) {
        const glm::dmat3 gram = glm::transpose(linear) * linear;
        const double s2 = traceOf(gram) / 3.0;
        if (!(s2 > 0.0))
            continue;
        scale_ += s2 * s2;
        if (isSimilarity(gram)) {
            sum4 += s2 * s2;
            sum3 += s2 * std::sqrt(s2);
            similar_count += 1.0;
            max_stretch_ = std::max(max_stretch_, std::sqrt(s2));
            continue;
        }
        max_stretch_ = std::max(max_stretch_, longestStretchOfGram(gram));
        const auto [group, added] = distinct.try_emplace(keyOf(gram));
        if (added)
            group->second = {gram,
                             glm::transpose(cofactor(linear)) * cofactor(linear),
                             squared(glm::determinant(linear)),
                             0.0,
                             0.0};
        group->second.count += 1.0;
        group->second.length_count += 1.0;
    }
    if (distinct.empty()) {
        length_ratio_ = sum4 > 0.0 ? sum3 / sum4 : 1.0;
        return;
    }
    for (const auto& [key, group] : distinct)
        groups_.push_back(group);
    if (sum4 > 0.0) { // all similarities weigh like one group of their mean scale
        const double s2 = std::sqrt(sum4 / similar_count);
        Group similar{glm::dmat3(s2), glm::dmat3(s2 * s2), s2 * s2 * s2, similar_count, 0.0};
        similar.length_count = sum3 / (s2 * std::sqrt(s2));
        groups_.push_back(similar);
    }
    if (groups_.size() > kMaxGroups) {
        tabulate();
        cluster();
    }
}

InstanceWeights::Directed InstanceWeights::exact(const glm::dvec3& normal) const {
    Directed sum;
    for (const Group& group : groups_) {
        const glm::dvec3 pulled = group.cofactor * normal;
        const double stretch2 = glm::dot(normal, pulled); // |C n|^2
        if (!(stretch2 > 0.0))
            continue;
        sum.face += group.count * group.determinant / std::sqrt(stretch2) / scale_;
        sum.pull += glm::outerProduct(pulled, pulled) * (group.count / stretch2 / scale_);
    }
    return sum;
}

InstanceWeights::Directed InstanceWeights::lookUp(const glm::dvec3& normal) const {
    const TableCell cell = cellOf(normal);
    const double x = cell.u * (kTableSide - 1);
    const double y = cell.v * (kTableSide - 1);
    const int x0 = std::clamp(static_cast<int>(x), 0, kTableSide - 2);
    const int y0 = std::clamp(static_cast<int>(y), 0, kTableSide - 2);
    Directed sum;
    for (int dy = 0; dy < 2; ++dy)
        for (int dx = 0; dx < 2; ++dx) {
            const Directed& at = table_[slotOf(cell.face, x0 + dx, y0 + dy)];
            const double share = (dx ? x - x0 : 1.0 - (x - x0)) * (dy ? y - y0 : 1.0 - (y - y0));
            sum.face += at.face * share;
            sum.pull += at.pull * share;
        }
    return sum;
}

double InstanceWeights::face(const glm::dvec3& normal) const {
    if (groups_.empty())
        return 1.0;
    return table_.empty() ? exact(normal).face : lookUp(normal).face;
}

void InstanceWeights::border(const glm::dvec3& edge,
                             const glm::dvec3& normal,
                             bool by_length,
                             std::vector<Plane>& out) const {
    out.clear();
    const double length2 = glm::dot(edge, edge);
    if (!(length2 > 0.0))
        return;
    if (groups_.empty()) {
        const glm::dvec3 across = glm::cross(edge, normal);
        const double length = glm::length(across);
        if (length > 0.0)
            out.push_back(
                {across / length, by_length ? std::sqrt(length2) * length_ratio_ : length2});
        return;
    }
    if (!table_.empty() && !by_length) {
        splitPull(edge, lookUp(normal).pull, out);
        return;
    }
    for (const Group& group : groups_) {
        const glm::dvec3 pulled = group.cofactor * normal;
        const double stretch2 = glm::dot(normal, pulled); // |C n|^2
        const glm::dvec3 across = glm::cross(edge, pulled);
        const double across2 = glm::dot(across, across);
        const double world2 = glm::dot(edge, group.gram * edge); // |M e|^2
        if (!(stretch2 > 0.0 && across2 > 0.0 && world2 > 0.0))
            continue;
        const double count = by_length ? group.length_count / std::sqrt(world2) : group.count;
        const double weight = count * across2 / stretch2 / scale_;
        out.push_back({across / std::sqrt(across2), weight});
    }
}

glm::dmat3 InstanceWeights::area() const {
    if (groups_.empty())
        return glm::dmat3(1.0);
    glm::dmat3 sum(0.0);
    for (const Group& group : groups_)
        sum += group.cofactor * (group.count / scale_); // cof(M^T M) = C^T C
    return sum;
}

void InstanceWeights::tabulate() {
    table_.resize(slotOf(3, 0, 0));
    for (int face = 0; face < 3; ++face)
        for (int y = 0; y < kTableSide; ++y)
            for (int x = 0; x < kTableSide; ++x) {
                glm::dvec3 n(0.0);
                n[face] = 1.0;
                n[(face + 1) % 3] = 2.0 * x / (kTableSide - 1) - 1.0;
                n[(face + 2) % 3] = 2.0 * y / (kTableSide - 1) - 1.0;
                table_[slotOf(face, x, y)] = exact(glm::normalize(n));
            }
}

// Borders by length cannot be tabulated over directions alone: groups of like size are averaged.
void InstanceWeights::cluster() {
    std::ranges::stable_sort(groups_, {}, [](const Group& g) { return traceOf(g.gram); });
    std::vector<Group> clusters;
    for (std::size_t c = 0; c < kMaxGroups; ++c) {
        const std::size_t begin = groups_.size() * c / kMaxGroups;
        const std::size_t end = groups_.size() * (c + 1) / kMaxGroups;
        Group mean;
        mean.gram = glm::dmat3(0.0);
        mean.count = 0.0;
        double weight4 = 0.0; // what the groups weigh by squared length: trace^2
        double weight3 = 0.0; // and by length
        for (std::size_t g = begin; g < end; ++g) {
            const Group& group = groups_[g];
            const double trace = traceOf(group.gram);
            mean.gram += group.gram * (group.count * trace);
            mean.count += group.count;
            weight4 += group.count * trace * trace;
            weight3 += group.length_count * trace * std::sqrt(trace);
        }
        const double trace = std::sqrt(weight4 / mean.count); // so that the sums are kept
        mean.gram *= trace / traceOf(mean.gram);
        mean.length_count = weight3 / (trace * std::sqrt(trace));
        mean.cofactor = cofactor(mean.gram);
        mean.determinant = glm::determinant(mean.gram);
        clusters.push_back(mean);
    }
    groups_ = std::move(clusters);
}

} // namespace lodestone
