// A sitting bunny as a hand scanner would give it: one closed mesh, finer where the scanner stayed
// longer, with fur and ripples.
#include "scene/generate/implicit.h"
#include "scene/generate/sample.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <tbb/parallel_for.h>

namespace lodestone::generate {

namespace {

constexpr std::size_t kTriangles = 69664;
constexpr double kScale = 0.12; // the shape below is 1.7 high

constexpr double kHeadTurn = -0.45;
constexpr double kEarLean = 0.38;
constexpr double kEarTurn = -0.5;

// Ellipsoid, turned in the xy plane (lean) and then about the upright axis (turn), radians.
struct Blob {
    glm::dvec3 center;
    glm::dvec3 radii;
    double blend; // width of the smooth join with what came before
    double lean = 0.0;
    double turn = 0.0;
};

// x: nose, y: up. Parts with z > 0 have a twin on the other side.
const std::array<Blob, 14> kBlobs{{
    {{-0.28, 0.50, 0.00}, {0.52, 0.43, 0.40}, 0.10, 0.15},                // back and belly
    {{0.22, 0.44, 0.00}, {0.33, 0.37, 0.29}, 0.16, -0.3},                 // chest
    {{0.42, 0.70, 0.00}, {0.20, 0.26, 0.18}, 0.14, 0.5},                  // neck
    {{0.57, 0.92, 0.00}, {0.26, 0.21, 0.19}, 0.10, -0.25},                // head
    {{0.76, 0.84, 0.00}, {0.13, 0.105, 0.115}, 0.08, -0.3},               // muzzle
    {{0.71, 0.83, 0.085}, {0.12, 0.10, 0.085}, 0.05},                     // cheeks
    {{-0.30, 0.36, 0.30}, {0.32, 0.33, 0.15}, 0.07, 0.3},                 // thighs
    {{-0.06, 0.075, 0.31}, {0.31, 0.085, 0.105}, 0.06, 0.04},             // hind feet
    {{0.36, 0.25, 0.135}, {0.095, 0.26, 0.095}, 0.07, 0.25},              // front legs
    {{0.47, 0.065, 0.135}, {0.15, 0.07, 0.085}, 0.05},                    // front paws
    {{-0.80, 0.36, 0.00}, {0.16, 0.15, 0.15}, 0.05},                      // tail
    {{0.37, 1.36, 0.15}, {0.105, 0.36, 0.055}, 0.06, kEarLean, kEarTurn}, // ears
    {{0.50, 1.05, 0.10}, {0.08, 0.12, 0.07}, 0.06, kEarLean},             // ear roots
    {{0.685, 0.960, 0.140}, {0.058, 0.050, 0.040}, 0.014},                // eyes
}};

// Takes world directions into the frame of something that leans and is turned.
glm::dmat3 intoFrame(double lean, double turn) {
    return glm::transpose(glm::dmat3(rotatedY(turn) * rotatedZ(lean)));
}

// About the distance (exact on a ball).
double ellipsoid(const glm::dvec3& p, const glm::dvec3& radii) {
    const glm::dvec3 a = p / radii;
    const glm::dvec3 b = a / radii;
    const double k = glm::length(a);
    const double l = glm::length(b);
    return l < 1e-12 ? -std::min({radii.x, radii.y, radii.z}) : k * (k - 1.0) / l;
}

// Polynomial smooth minimum (Quilez).
double join(double a, double b, double width) {
    const double h = std::max(width - std::abs(a - b), 0.0) / width;
    return std::min(a, b) - h * h * width * 0.25;
}

class BunnyField {
public:
    BunnyField() {
        for (const Blob& blob : kBlobs)
            placed_.push_back({blob,
                               intoFrame(blob.lean, blob.turn),
                               std::max({blob.radii.x, blob.radii.y, blob.radii.z})});
        ear_ = intoFrame(kEarLean, kEarTurn);
    }

    double operator()(const glm::dvec3& world) const {
        const glm::dvec3 p = facingForward(world);
        double d = 1e9;
        for (const Placed& placed : placed_) {
            glm::dvec3 q = p;
            if (placed.blob.center.z > 0.0)
                q.z = std::abs(q.z);
            q -= placed.blob.center;
            const double reach = placed.longest + d + 2.0 * placed.blob.blend;
            if (reach < 0.0 || glm::dot(q, q) < reach * reach)
                d = join(d, ellipsoid(placed.frame * q, placed.blob.radii), placed.blob.blend);
        }
        if (p.y > 0.9) { // the hollow of the ears
            const glm::dvec3 q(p.x - 0.435, p.y - 1.38, std::abs(p.z) - 0.185);
            d = -join(-d, ellipsoid(ear_ * q, {0.055, 0.27, 0.045}), 0.03);
        }
        // A flat underside to sit on.
        return -join(-d, world.y - 0.012, 0.03);
    }

private:
    struct Placed {
        Blob blob;
        glm::dmat3 frame;
        double longest;
    };

    // The head looks a little to the side: undoes that.
    static glm::dvec3 facingForward(const glm::dvec3& world) {
        const double up = smoothStep(0.55, 1.0, world.y);
        if (up <= 0.0)
            return world;
        constexpr double kPivotX = 0.45;
        const double c = cosine(kHeadTurn * up);
        const double s = sine(kHeadTurn * up);
        const double x = world.x - kPivotX;
        return {kPivotX + c * x - s * world.z, world.y, s * x + c * world.z};
    }

    std::vector<Placed> placed_;
    glm::dmat3 ear_{1.0};
};

} // namespace

ScenePtr makeBunny(std::uint64_t seed) {
    Random random(seed);
    const auto noise_seed = static_cast<std::uint32_t>(random.bits());
    const BunnyField bunny_field;
    const Field field = std::cref(bunny_field);
    Mesh mesh = polygonize(field, {{-1.06, -0.04, -0.56}, 0.0185, {110, 98, 61}});
    coarsen(mesh, kTriangles, [&](const glm::dvec3& p) {
        const double patches = 1.0 + 0.35 * fractalNoise(p * 2.3, noise_seed, 2);
        return patches * (1.15 - 0.35 * smoothStep(0.7, 1.0, p.y));
    });
    relax(mesh, field, 3);
    const std::vector<glm::dvec3> normals = vertexNormals(mesh);
    tbb::parallel_for(std::size_t{0}, mesh.positions.size(), [&](std::size_t v) {
        glm::dvec3& p = mesh.positions[v];
        // Fur lies along the body; the face, thin ears and paws have short hair.
        const double face = smoothStep(0.45, 0.62, p.x) * smoothStep(0.68, 0.80, p.y);
        const double length = (1.0 - 0.75 * smoothStep(1.0, 1.15, p.y)) *
                              smoothStep(0.0, 0.15, p.y) * (1.0 - 0.65 * face);
        const double tufts = fractalNoise({p.x * 5.0, p.y * 7.0, p.z * 7.0}, noise_seed + 5, 2);
        const double strands =
            noise({p.x * 13.0 + p.y * 5.0, p.y * 30.0, p.z * 30.0}, noise_seed + 8);
        const double ripples = noise(p * 70.0, noise_seed + 11);
        p += normals[v] *
             ((0.016 * tufts + 0.010 * strands) * (0.15 + 0.85 * length) + 0.0016 * ripples);
        p *= kScale;
    });
    Sample sample("bunny");
    const std::uint32_t bunny = sample.add("bunny", mesh, kPi, {0xC8B59A, 0.85});
    sample.place(bunny, Trs{}, kNone);
    return sample.finish();
}

} // namespace lodestone::generate
