#include "scene/generate/maple_parts.h"

#include <algorithm>

namespace lodestone::generate {

namespace {

enum class Rim { Tip, Sinus, Tooth, Notch, SmallTooth, SmallNotch };

struct RimPoint {
    double x;
    double y;
    Rim kind;
};

// The right half of the outline, from the sinus at the stalk to below the tip; the blade's root is
// the origin and every point is seen from it in rising angle.
constexpr std::array<RimPoint, 23> kHalfRim{{
    {0.07, -0.07, Rim::Sinus},     {0.19, -0.15, Rim::Notch}, {0.30, -0.19, Rim::Tooth},
    {0.33, -0.12, Rim::Notch},     {0.50, -0.11, Rim::Tip},   {0.41, -0.01, Rim::SmallNotch},
    {0.45, 0.06, Rim::SmallTooth}, {0.29, 0.09, Rim::Sinus},  {0.44, 0.16, Rim::SmallNotch},
    {0.52, 0.20, Rim::SmallTooth}, {0.50, 0.24, Rim::Notch},  {0.68, 0.34, Rim::Tooth},
    {0.62, 0.37, Rim::Notch},      {0.78, 0.55, Rim::Tip},    {0.56, 0.47, Rim::Notch},
    {0.53, 0.56, Rim::Tooth},      {0.37, 0.45, Rim::Notch},  {0.21, 0.37, Rim::Sinus},
    {0.22, 0.52, Rim::Notch},      {0.30, 0.76, Rim::Tooth},  {0.20, 0.72, Rim::SmallNotch},
    {0.19, 0.89, Rim::SmallTooth}, {0.10, 0.88, Rim::Notch},
}};
constexpr double kStalkLength = 0.42;

bool isSmall(Rim kind) {
    return kind == Rim::SmallTooth || kind == Rim::SmallNotch;
}

std::vector<RimPoint> wholeRim(const LeafShape& shape, Random& random) {
    std::vector<RimPoint> rim;
    const auto add = [&](RimPoint p, double side) {
        if (isSmall(p.kind) && !shape.small_teeth)
            return;
        double reach = 1.0 + 0.05 * (random.unit() - 0.5);
        if (p.kind == Rim::Sinus)
            reach += 0.45 * (1.0 - shape.lobe_depth);
        else if (p.kind == Rim::Tooth)
            reach -= 0.08 * (1.0 - shape.lobe_depth);
        rim.push_back({p.x * reach * side, p.y * reach, p.kind});
    };
    for (const RimPoint& p : kHalfRim)
        add(p, 1.0);
    add({0.0, 1.12, Rim::Tip}, 1.0);
    std::for_each(kHalfRim.rbegin(), kHalfRim.rend(), [&](const RimPoint& p) { add(p, -1.0); });
    return rim;
}

// A flat blade point lifted by curvature and veins. q: 0 at the root, 1 at the rim.
glm::dvec3 lifted(const LeafShape& shape, const RimPoint& rim, double q) {
    const double x = rim.x * q;
    const double y = rim.y * q;
    double vein = 0.0;
    if (rim.kind == Rim::Tip)
        vein = -0.030 * (1.0 - q);
    else if (rim.kind == Rim::Sinus)
        vein = 0.022;
    else if (rim.kind == Rim::Notch || rim.kind == Rim::SmallNotch)
        vein = 0.012 * q;
    const double z = shape.cup * (x * x + 0.3 * (y - 0.4) * (y - 0.4)) - shape.droop * y * y * 0.6 +
                     shape.fold * std::max(x, -x) + shape.twist * x * y + vein -
                     (rim.kind == Rim::Tip ? 0.07 * q * q : 0.0);
    return {x, kStalkLength + y, z};
}

} // namespace

Mesh makeLeaf(const LeafShape& shape, Random& random) {
    Mesh mesh;
    const std::vector<RimPoint> rim = wholeRim(shape, random);
    const auto count = static_cast<std::uint32_t>(rim.size());
    const std::uint32_t root = mesh.addVertex({0.0, kStalkLength, 0.0});
    std::vector<std::uint32_t> coarse; // rim indices that the innermost ring has
    std::vector<std::uint32_t> inner;
    for (std::uint32_t i = 0; i < count; ++i)
        if (rim[i].kind == Rim::Tip || rim[i].kind == Rim::Sinus) {
            coarse.push_back(i);
            inner.push_back(mesh.addVertex(lifted(shape, rim[i], 0.42)));
        }
    const auto middle = static_cast<std::uint32_t>(mesh.positions.size());
    for (const double q : {0.74, 1.0})
        for (const RimPoint& p : rim)
            mesh.addVertex(lifted(shape, p, q));
    const std::uint32_t outer = middle + count;
    for (std::size_t k = 1; k < coarse.size(); ++k) {
        mesh.addTriangle(root, inner[k - 1], inner[k]);
        const std::uint32_t half = (coarse[k - 1] + coarse[k]) / 2;
        for (std::uint32_t i = coarse[k - 1]; i < coarse[k]; ++i)
            mesh.addTriangle(inner[i < half ? k - 1 : k], middle + i, middle + i + 1);
        mesh.addTriangle(inner[k - 1], middle + half, inner[k]);
    }
    for (std::uint32_t i = 0; i + 1 < count; ++i)
        mesh.addQuad(middle + i, outer + i, outer + i + 1, middle + i + 1);
    const std::array<PathPoint, 5> stalk{{{{0, 0, 0}, 0.016},
                                          {{0, kStalkLength * 0.15, 0.02}, 0.012},
                                          {{0, kStalkLength * 0.4, 0.03}, 0.011},
                                          {{0, kStalkLength * 0.8, 0.02}, 0.010},
                                          {{0, kStalkLength + 0.03, -0.012}, 0.008}}};
    addTube(mesh, stalk, 4);
    return mesh;
}

Mesh makeWingedSeeds() {
    Mesh mesh;
    for (const double side : {1.0, -1.0}) {
        const glm::dmat4 turn = rotatedZ(side > 0.0 ? 0.0 : 1.9) * rotatedZ(-0.95);
        Mesh half;
        const Mesh seed = ball(0);
        half.append(seed, moved({0.0, -0.32, 0.0}) * scaled({0.10, 0.14, 0.06}));
        const std::array<glm::dvec2, 6> left{{{-0.05, -0.36},
                                              {-0.10, -0.52},
                                              {-0.16, -0.68},
                                              {-0.17, -0.84},
                                              {-0.10, -0.96},
                                              {0.0, -1.0}}};
        const std::array<glm::dvec2, 6> right{{{0.06, -0.36},
                                               {0.05, -0.52},
                                               {0.06, -0.68},
                                               {0.08, -0.84},
                                               {0.07, -0.94},
                                               {0.03, -0.99}}};
        const auto base = static_cast<std::uint32_t>(half.positions.size());
        for (std::size_t i = 0; i < left.size(); ++i) {
            half.addVertex({left[i].x, left[i].y, 0.03 * left[i].y * left[i].y});
            half.addVertex({right[i].x, right[i].y, -0.01});
        }
        for (std::uint32_t i = 0; i + 1 < left.size(); ++i)
            half.addQuad(base + 2 * i, base + 2 * i + 2, base + 2 * i + 3, base + 2 * i + 1);
        const std::array<PathPoint, 2> stem{{{{0, 0, 0}, 0.012}, {{0, -0.26, 0}, 0.018}}};
        addTube(half, stem, 3);
        mesh.append(half, turn);
    }
    return mesh;
}

} // namespace lodestone::generate
