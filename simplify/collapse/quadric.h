#pragma once
// Quadric error metric in single precision.
//
// A quadric is stored relative to the position of its vertex, not to the origin: its constant is
// then the (small) error that the vertex has now and its linear part the (small) gradient, so that
// floats keep their full relative precision however dense the mesh is (a quadric about the origin
// loses the error of a fine mesh in cancellation). Source: Garland and Heckbert 1997.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace lodestone {

// Four numbers at once; the same code places one edge or four.
using Float4 = float __attribute__((vector_size(16)));

// Four floats from any address.
inline Float4 loadFour(const void* from) {
    Float4 four;
    std::memcpy(&four, from, sizeof(four));
    return four;
}

// Four rows to four columns.
inline std::array<Float4, 4> transposed(const std::array<Float4, 4>& rows) {
    const Float4 xy01 = __builtin_shufflevector(rows[0], rows[1], 0, 4, 1, 5);
    const Float4 zw01 = __builtin_shufflevector(rows[0], rows[1], 2, 6, 3, 7);
    const Float4 xy23 = __builtin_shufflevector(rows[2], rows[3], 0, 4, 1, 5);
    const Float4 zw23 = __builtin_shufflevector(rows[2], rows[3], 2, 6, 3, 7);
    return {__builtin_shufflevector(xy01, xy23, 0, 1, 4, 5),
            __builtin_shufflevector(xy01, xy23, 2, 3, 6, 7),
            __builtin_shufflevector(zw01, zw23, 0, 1, 4, 5),
            __builtin_shufflevector(zw01, zw23, 2, 3, 6, 7)};
}

template <class T>
struct Vector3 {
    T x{};
    T y{};
    T z{};
};

using Float3 = Vector3<float>;

template <class T>
Vector3<T> operator+(const Vector3<T>& a, const Vector3<T>& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}

template <class T>
Vector3<T> operator-(const Vector3<T>& a, const Vector3<T>& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

template <class T>
Vector3<T> operator*(const Vector3<T>& a, float s) {
    return {a.x * s, a.y * s, a.z * s};
}

template <class T>
T dot(const Vector3<T>& a, const Vector3<T>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class T>
Vector3<T> cross(const Vector3<T>& a, const Vector3<T>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// a where the mask is set, else b.
inline float select(bool mask, float a, float b) {
    return mask ? a : b;
}

inline Float4 select(decltype(Float4{} < Float4{}) mask, Float4 a, Float4 b) {
    return mask ? a : b;
}

inline bool allOf(bool mask) {
    return mask;
}

inline bool allOf(decltype(Float4{} < Float4{}) mask) {
    return (mask[0] & mask[1] & mask[2] & mask[3]) != 0;
}

// error(x) = x.A.x + 2 b.x + c, x relative to the vertex.
template <class T>
struct QuadricOf {
    T xx{}, yy{}, zz{}, xy{}, xz{}, yz{}; // A, symmetric
    T bx{}, by{}, bz{};                   // b
    T c{};
    T weight{}; // sum of the face weights in it, to turn an error into a distance
};

using Quadric = QuadricOf<float>;

// Adds weight * (n.x + offset)^2. n of any length; with a unit normal that is the squared distance
// to its plane, offset: of the vertex.
template <class T>
void addSquare(QuadricOf<T>& q, const Vector3<T>& n, const T& offset, const T& weight) {
    const Vector3<T> w{n.x * weight, n.y * weight, n.z * weight};
    q.xx += w.x * n.x;
    q.yy += w.y * n.y;
    q.zz += w.z * n.z;
    q.xy += w.x * n.y;
    q.xz += w.x * n.z;
    q.yz += w.y * n.z;
    q.bx += w.x * offset;
    q.by += w.y * offset;
    q.bz += w.z * offset;
    q.c += weight * offset * offset;
}

inline Float3 apply(const Quadric& q, Float3 v) {
    return {q.xx * v.x + q.xy * v.y + q.xz * v.z,
            q.xy * v.x + q.yy * v.y + q.yz * v.z,
            q.xz * v.x + q.yz * v.y + q.zz * v.z};
}

template <class T>
Vector3<T> apply(const QuadricOf<T>& q, const Vector3<T>& v) {
    return {q.xx * v.x + q.xy * v.y + q.xz * v.z,
            q.xy * v.x + q.yy * v.y + q.yz * v.z,
            q.xz * v.x + q.yz * v.y + q.zz * v.z};
}

// The same error function about another origin: x relative to (vertex + shift).
inline Quadric translated(const Quadric& q, Float3 shift) {
    Quadric r = q;
    const Float3 a = apply(q, shift);
    r.bx += a.x;
    r.by += a.y;
    r.bz += a.z;
    r.c += dot(shift, {2.0f * q.bx + a.x, 2.0f * q.by + a.y, 2.0f * q.bz + a.z});
    r.c = std::max(r.c, 0.0f);
    return r;
}

// Sum of two quadrics about the same origin.
template <class T>
QuadricOf<T> sum(const QuadricOf<T>& p, const QuadricOf<T>& q) {
    return {p.xx + q.xx,
            p.yy + q.yy,
            p.zz + q.zz,
            p.xy + q.xy,
            p.xz + q.xz,
            p.yz + q.yz,
            p.bx + q.bx,
            p.by + q.by,
            p.bz + q.bz,
            p.c + q.c,
            p.weight + q.weight};
}

// p - q, about the same origin.
inline Quadric difference(const Quadric& p, const Quadric& q) {
    return {p.xx - q.xx,
            p.yy - q.yy,
            p.zz - q.zz,
            p.xy - q.xy,
            p.xz - q.xz,
            p.yz - q.yz,
            p.bx - q.bx,
            p.by - q.by,
            p.bz - q.bz,
            p.c - q.c,
            p.weight - q.weight};
}

template <class T>
T evaluate(const QuadricOf<T>& q, const Vector3<T>& x) {
    const Vector3<T> a = apply(q, x);
    const T two = T{} + 2.0f;
    return dot(x, {a.x + two * q.bx, a.y + two * q.by, a.z + two * q.bz}) + q.c;
}

template <class T>
struct PlacementOf {
    Vector3<T> at; // relative to the edge's midpoint
    T cost{};      // quadric error there, >= 0
    T key{};       // what the queue orders by, >= 0
};

using Placement = PlacementOf<float>;

// Sum of two quadrics about the middle of their vertices; half: from the middle to the second.
template <class T>
QuadricOf<T> sumAtMiddle(const QuadricOf<T>& p, const QuadricOf<T>& q, const Vector3<T>& half) {
    QuadricOf<T> s = sum(p, q);
    const Vector3<T> slope{p.bx - q.bx, p.by - q.by, p.bz - q.bz};
    s.c += dot(slope, half) * 2.0f + dot(half, apply(s, half));
    s.bx += (p.xx - q.xx) * half.x + (p.xy - q.xy) * half.y + (p.xz - q.xz) * half.z;
    s.by += (p.xy - q.xy) * half.x + (p.yy - q.yy) * half.y + (p.yz - q.yz) * half.z;
    s.bz += (p.xz - q.xz) * half.x + (p.yz - q.yz) * half.y + (p.zz - q.zz) * half.z;
    return s;
}

// Best place for the merged vertex of an edge. s: sum about the midpoint; at_ends: the error that
// the ends already have; half: from the midpoint to the second end.
// Tikhonov towards the midpoint keeps flat and straight neighbourhoods well-posed; a solution
// farther out than the edge is long falls back to the best of both ends and the middle.
// The queue forgives two fifths of the error that the ends already have: none would hold regions
// back only because they were simplified before (larger mean distance), all of it would let a
// region sink ever deeper (larger maximum). Short edges have a tiny preference.
template <class T>
PlacementOf<T> placeMerged(const QuadricOf<T>& s, const T& at_ends, const Vector3<T>& half) {
    constexpr float kTikhonov = 1e-5f;
    constexpr float kShortEdge = 1e-7f;
    constexpr float kForgiven = 0.4f;
    constexpr float kReach = 4.0f; // squared distance from the midpoint over |half|^2
    const T zero{};
    const T one = zero + 1.0f;

    const T trace = s.xx + s.yy + s.zz;
    const T length2 = dot(half, half);
    const T lambda = trace * kTikhonov;

    // Cholesky (L D L^T) of A + lambda I; positive definite, or all zero.
    const auto inverse = [&](const T& d) { return select(d > zero, one / d, zero); };
    const T d0 = s.xx + lambda;
    const T i0 = inverse(d0);
    const T l10 = s.xy * i0;
    const T l20 = s.xz * i0;
    const T d1 = s.yy + lambda - l10 * s.xy;
    const T i1 = inverse(d1);
    const T m21 = s.yz - l20 * s.xy;
    const T l21 = m21 * i1;
    const T d2 = s.zz + lambda - l20 * s.xz - l21 * m21;
    const T i2 = inverse(d2);
    const T y0 = -s.bx;
    const T y1 = -s.by - l10 * y0;
    const T y2 = -s.bz - l20 * y0 - l21 * y1;
    Vector3<T> x;
    x.z = y2 * i2;
    x.y = y1 * i1 - l21 * x.z;
    x.x = y0 * i0 - l10 * x.y - l20 * x.z;

    // A x + b = -lambda x at the optimum, so its error needs no second product with A.
    const T reach2 = dot(x, x);
    const T optimal = s.c + dot(x, {s.bx, s.by, s.bz}) - lambda * reach2;
    const auto near = reach2 <= length2 * kReach;

    PlacementOf<T> best{{zero, zero, zero}, s.c, zero};
    const auto offer = [&](const auto& better, const Vector3<T>& at, const T& cost) {
        best.at.x = select(better, at.x, best.at.x);
        best.at.y = select(better, at.y, best.at.y);
        best.at.z = select(better, at.z, best.at.z);
        best.cost = select(better, cost, best.cost);
    };
    if (!allOf(near)) // rare
        for (const float side : {1.0f, -1.0f}) {
            const Vector3<T> end = half * side;
            const T cost = evaluate(s, end);
            offer(cost < best.cost, end, cost);
        }
    offer(near, x, optimal);
    best.cost = select(best.cost > zero, best.cost, zero); // also where it is not a number
    const T added = best.cost - at_ends * kForgiven;
    best.key = select(added > zero, added, zero) + trace * length2 * kShortEdge;
    return best;
}

template <class T>
PlacementOf<T> placeEdge(const QuadricOf<T>& p, const QuadricOf<T>& q, const Vector3<T>& half) {
    return placeMerged(sumAtMiddle(p, q, half), p.c + q.c, half);
}

} // namespace lodestone
