#pragma once
// Quadric error metric in single precision.
//
// A quadric is stored relative to the position of its vertex, not to the origin: its constant is
// then the (small) error that the vertex has now and its linear part the (small) gradient, so that
// floats keep their full relative precision however dense the mesh is (a quadric about the origin
// loses the error of a fine mesh in cancellation). Source: Garland and Heckbert 1997.
#include <algorithm>
#include <cmath>

namespace lodestone {

struct Float3 {
    float x = 0.0f;
    float y = 0.0f;
    float z = 0.0f;
};

inline Float3 operator+(Float3 a, Float3 b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}

inline Float3 operator-(Float3 a, Float3 b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

inline Float3 operator*(Float3 a, float s) {
    return {a.x * s, a.y * s, a.z * s};
}

inline float dot(Float3 a, Float3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

inline Float3 cross(Float3 a, Float3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// error(x) = x.A.x + 2 b.x + c, x relative to the vertex.
struct Quadric {
    float xx = 0.0f, yy = 0.0f, zz = 0.0f, xy = 0.0f, xz = 0.0f, yz = 0.0f; // A, symmetric
    float bx = 0.0f, by = 0.0f, bz = 0.0f;                                  // b
    float c = 0.0f;
    float weight = 0.0f; // sum of the face weights in it, to turn an error into a distance
};

// Adds weight * (distance to the plane with unit normal n at offset from the vertex)^2.
inline void addPlane(Quadric& q, Float3 n, float offset, float weight) {
    const Float3 w = n * weight;
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
inline Quadric sum(const Quadric& p, const Quadric& q) {
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

inline float evaluate(const Quadric& q, Float3 x) {
    const Float3 a = apply(q, x);
    return std::max(dot(x, {a.x + 2.0f * q.bx, a.y + 2.0f * q.by, a.z + 2.0f * q.bz}) + q.c, 0.0f);
}

struct Placement {
    Float3 at;         // relative to the edge's midpoint
    float cost = 0.0f; // quadric error there, >= 0
    float key = 0.0f;  // what the queue orders by: cost plus a tiny preference for short edges
};

// Sum of two quadrics about the middle of their vertices; half: from the middle to the second.
inline Quadric sumAtMiddle(const Quadric& p, const Quadric& q, Float3 half) {
    Quadric s = sum(p, q);
    const Float3 slope{p.bx - q.bx, p.by - q.by, p.bz - q.bz};
    s.c += 2.0f * dot(slope, half) + dot(half, apply(s, half));
    s.bx += (p.xx - q.xx) * half.x + (p.xy - q.xy) * half.y + (p.xz - q.xz) * half.z;
    s.by += (p.xy - q.xy) * half.x + (p.yy - q.yy) * half.y + (p.yz - q.yz) * half.z;
    s.bz += (p.xz - q.xz) * half.x + (p.yz - q.yz) * half.y + (p.zz - q.zz) * half.z;
    return s;
}

// Best place for the merged vertex of an edge. half: from the midpoint to the second end.
// Tikhonov towards the midpoint keeps flat and straight neighbourhoods well-posed; a solution
// farther out than the edge is long falls back to the best of both ends and the middle.
inline Placement placeEdge(const Quadric& p, const Quadric& q, Float3 half) {
    constexpr float kTikhonov = 1e-5f;
    constexpr float kShortEdge = 1e-7f;
    constexpr float kReach = 4.0f; // squared distance from the midpoint over |half|^2

    const Quadric s = sumAtMiddle(p, q, half);
    const float trace = s.xx + s.yy + s.zz;
    const float length2 = dot(half, half);
    const float lambda = kTikhonov * trace;

    // Cholesky (L D L^T) of A + lambda I; positive definite, or all zero.
    const float d0 = s.xx + lambda;
    const float i0 = d0 > 0.0f ? 1.0f / d0 : 0.0f;
    const float l10 = s.xy * i0;
    const float l20 = s.xz * i0;
    const float d1 = s.yy + lambda - l10 * s.xy;
    const float i1 = d1 > 0.0f ? 1.0f / d1 : 0.0f;
    const float m21 = s.yz - l20 * s.xy;
    const float l21 = m21 * i1;
    const float d2 = s.zz + lambda - l20 * s.xz - l21 * m21;
    const float i2 = d2 > 0.0f ? 1.0f / d2 : 0.0f;
    const float y0 = -s.bx;
    const float y1 = -s.by - l10 * y0;
    const float y2 = -s.bz - l20 * y0 - l21 * y1;
    Float3 x;
    x.z = y2 * i2;
    x.y = y1 * i1 - l21 * x.z;
    x.x = y0 * i0 - l10 * x.y - l20 * x.z;

    Placement best;
    const float reach2 = dot(x, x);
    if (reach2 <= kReach * length2) {
        best.at = x; // A x + b = -lambda x there, so the error needs no second product with A
        best.cost = std::max(s.c + dot(x, {s.bx, s.by, s.bz}) - lambda * reach2, 0.0f);
    } else {
        best.cost = std::max(s.c, 0.0f);
        for (const Float3 end : {half, half * -1.0f}) {
            const float cost = evaluate(s, end);
            if (cost < best.cost) {
                best.cost = cost;
                best.at = end;
            }
        }
    }
    best.key = best.cost + kShortEdge * trace * length2;
    return best;
}

} // namespace lodestone
