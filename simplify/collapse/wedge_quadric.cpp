#include "simplify/collapse/wedge_quadric.h"

namespace lodestone {

namespace {

Float3 gradientOf(Float4 line) {
    return {line[0], line[1], line[2]};
}

// Half the harmonic mean of two weights: what a difference between two means weighs.
template <class T>
T mergeWeight(const T& a, const T& b) {
    const T both = a + b;
    const T zero{};
    return select(both > zero, a * b / both, zero);
}

} // namespace

void WedgeQuadrics::reset(std::size_t wedge_count, std::size_t value_count) {
    value_count_ = value_count;
    weights_.assign(value_count > 0 ? wedge_count : 0, 0.0f);
    lines_.assign(wedge_count * value_count, Float4{});
}

void WedgeQuadrics::setValues(std::uint32_t wedge, std::span<const float> values) {
    for (std::size_t i = 0; i < value_count_; ++i)
        lines_[wedge * value_count_ + i][3] = values[i];
}

Quadric WedgeQuadrics::addFace(const Face& face) {
    // Slivers have no say across their height: beyond this squared ratio it is taken as longer.
    constexpr float kSliver = 1e-4f;
    const Float3 u = face.positions[1] - face.positions[0];
    const Float3 v = face.positions[2] - face.positions[0];
    const Float3 normal = cross(u, v);
    const float longest2 = std::max({dot(u, u), dot(v, v), dot(u - v, u - v)});
    const float scale = 1.0f / (dot(normal, normal) + kSliver * longest2 * longest2);
    // A gradient is s times how much the second corner's value is larger than the first's, plus t
    // times how much the third's is.
    const Float3 s = cross(v, normal) * scale;
    const Float3 t = cross(normal, u) * scale;
    const Float4 s_line = Float4{s.x, s.y, s.z, 0.0f} * face.weight;
    const Float4 t_line = Float4{t.x, t.y, t.z, 0.0f} * face.weight;
    Float4* const first = lines_.data() + face.wedges[0] * value_count_;
    Float4* const second = lines_.data() + face.wedges[1] * value_count_;
    Float4* const third = lines_.data() + face.wedges[2] * value_count_;
    float ss = 0.0f;
    float st = 0.0f;
    float tt = 0.0f;
    for (std::size_t i = 0; i < value_count_; ++i) {
        const float along_s = second[i][3] - first[i][3];
        const float along_t = third[i][3] - first[i][3];
        const Float4 weighted = s_line * along_s + t_line * along_t;
        first[i] += weighted;
        second[i] += weighted;
        third[i] += weighted;
        ss += along_s * along_s;
        st += along_s * along_t;
        tt += along_t * along_t;
    }
    for (const std::uint32_t wedge : face.wedges)
        weights_[wedge] += face.weight;
    // All gradients' squares at once: s p^T + t q^T.
    const Float3 p = (s * ss + t * st) * face.weight;
    const Float3 q = (s * st + t * tt) * face.weight;
    Quadric gained;
    gained.xx = s.x * p.x + t.x * q.x;
    gained.yy = s.y * p.y + t.y * q.y;
    gained.zz = s.z * p.z + t.z * q.z;
    gained.xy = s.x * p.y + t.x * q.y;
    gained.xz = s.x * p.z + t.x * q.z;
    gained.yz = s.y * p.z + t.y * q.z;
    return gained;
}

Quadric WedgeQuadrics::finish(std::uint32_t wedge) {
    Quadric lost;
    const float weight = weights_[wedge];
    for (std::size_t i = 0; i < value_count_; ++i) {
        Float4& line = lines_[wedge * value_count_ + i];
        const float value = line[3];
        if (weight > 0.0f)
            line /= weight;
        line[3] = value;
        addSquare(lost, gradientOf(line), 0.0f, weight);
    }
    return lost;
}

void WedgeQuadrics::move(std::uint32_t wedge, Float3 by) {
    for (std::size_t i = 0; i < value_count_; ++i) {
        Float4& line = lines_[wedge * value_count_ + i];
        line[3] += dot(gradientOf(line), by);
    }
}

Quadric WedgeQuadrics::merge(std::uint32_t into, std::uint32_t from) {
    Quadric gained;
    const float weight = mergeWeight(weights_[into], weights_[from]);
    const float both = weights_[into] + weights_[from];
    const float share = both > 0.0f ? weights_[from] / both : 0.0f;
    for (std::size_t i = 0; i < value_count_; ++i) {
        Float4& line = lines_[into * value_count_ + i];
        const Float4 difference = lines_[from * value_count_ + i] - line;
        addSquare(gained, gradientOf(difference), difference[3], weight);
        line += difference * share;
    }
    weights_[into] = both;
    return gained;
}

void WedgeQuadrics::addMerge(QuadricOf<float>& sum,
                             std::uint32_t first,
                             std::uint32_t second,
                             const Vector3<float>& half) const {
    const float weight = mergeWeight(weights_[first], weights_[second]);
    for (std::size_t i = 0; i < value_count_; ++i) {
        const Float4 a = lines_[first * value_count_ + i];
        const Float4 b = lines_[second * value_count_ + i];
        addSquare(sum, gradientOf(a - b), a[3] - b[3] + dot(gradientOf(a + b), half), weight);
    }
}

void WedgeQuadrics::addMerges(QuadricOf<Float4>& sum,
                              const std::array<std::uint32_t, 4>& first,
                              const std::array<std::uint32_t, 4>& second,
                              const Vector3<Float4>& half,
                              const Float4& share) const {
    const auto weight_of = [&](const std::array<std::uint32_t, 4>& w) {
        return Float4{weights_[w[0]], weights_[w[1]], weights_[w[2]], weights_[w[3]]};
    };
    const Float4 weight = mergeWeight(weight_of(first), weight_of(second)) * share;
    for (std::size_t i = 0; i < value_count_; ++i) {
        const auto columns_of = [&](const std::array<std::uint32_t, 4>& w) {
            return transposed({lines_[w[0] * value_count_ + i],
                               lines_[w[1] * value_count_ + i],
                               lines_[w[2] * value_count_ + i],
                               lines_[w[3] * value_count_ + i]});
        };
        const std::array<Float4, 4> a = columns_of(first);
        const std::array<Float4, 4> b = columns_of(second);
        const Vector3<Float4> apart{a[0] - b[0], a[1] - b[1], a[2] - b[2]};
        const Vector3<Float4> both{a[0] + b[0], a[1] + b[1], a[2] + b[2]};
        addSquare(sum, apart, a[3] - b[3] + dot(both, half), weight);
    }
}

} // namespace lodestone
