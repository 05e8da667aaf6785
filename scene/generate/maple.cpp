// An autumn maple: trunk, boughs, branches, twigs, and leaves on the twigs.
#include "scene/generate/maple_parts.h"
#include "scene/generate/sample.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodestone::generate {

namespace {

constexpr std::size_t kInstances = 9324;
constexpr std::size_t kTriangles = 1818074;
constexpr std::size_t kBoughs = 16;
constexpr std::size_t kBranches = 120;
constexpr std::size_t kTwigs = 760;
constexpr std::size_t kSeeds = 260;
constexpr std::size_t kLeaves = kInstances - 1 - kBoughs - kBranches - kTwigs - kSeeds;

constexpr double kTrunkHeight = 6.3;
constexpr double kCrownLow = 1.75;
constexpr double kCrownHigh = 8.1;
constexpr double kCrownRadius = 3.35;

// Leaf colours from the sunlit outside of the crown to its shaded inside.
constexpr std::array<std::uint32_t, 8> kLeafColors{
    {0xA81E1C, 0xC4301C, 0xD9481C, 0xE2661F, 0xE98523, 0xEEA42C, 0xF0BE3F, 0xBFA63A}};

// A limb in the world: where others attach.
struct Grown {
    const Limb* shape;
    Trs trs;

    glm::dvec3 at(double t) const {
        return trs.translation + trs.rotation * (shape->at(t) * trs.scale);
    }

    double radiusAt(double t) const { return shape->radiusAt(t) * trs.scale.x; }

    glm::dvec3 headingAt(double t) const { return glm::normalize(at(t + 0.05) - at(t - 0.05)); }
};

// The crown's radius at a height, in the direction of an angle: a dome with a rounded underside
// and lobes, so that the outline is not a ball's.
double crownRadius(double y, double angle, std::uint32_t seed) {
    const double h = (y - kCrownLow) / (kCrownHigh - kCrownLow);
    if (h <= 0.0 || h >= 1.0)
        return 0.0;
    constexpr double kWidest = 0.34;
    const double u =
        h < kWidest ? (kWidest - h) / (kWidest + 0.08) : (h - kWidest) / (1.0 - kWidest);
    const double lobes = noise({1.3 * cosine(angle), y * 0.75, 1.3 * sine(angle)}, seed);
    return kCrownRadius * std::sqrt(1.0 - u * u) * (1.0 + 0.16 * lobes);
}

class MapleBuilder {
public:
    explicit MapleBuilder(std::uint64_t seed)
        : random_(seed), crown_seed_(static_cast<std::uint32_t>(random_.bits())), sample_("maple") {
    }

    ScenePtr build();

private:
    struct LimbKind {
        Limb limb;
        std::uint32_t submesh;
    };

    void makeParts();
    void growBoughs();
    void growBranches();
    void growTwigs();
    void growLeaves();
    void placeLeaves();
    void placeSeeds();
    glm::dvec3 crownPoint(std::size_t index, std::size_t count, double depth);
    Grown attach(const LimbKind& kind,
                 const glm::dvec3& target,
                 double longest,
                 std::span<const Grown> parents);

    Random random_;
    std::uint32_t crown_seed_;
    Sample sample_;
    Limb trunk_;
    std::vector<LimbKind> boughs_;
    std::vector<LimbKind> branches_;
    std::vector<Twig> twigs_;
    std::vector<LimbKind> twig_limbs_;
    std::vector<std::uint32_t> leaves_;
    std::uint32_t seeds_ = 0;
    std::vector<Grown> grown_; // trunk, boughs, branches
    std::vector<Trs> twig_at_;
    std::vector<std::size_t> twig_kind_;

    struct LeafSpot {
        Trs trs;
        double warmth;
    };

    std::vector<LeafSpot> leaf_spots_;
    std::vector<Trs> seed_spots_;
};

void MapleBuilder::makeParts() {
    const Look wood{0x7A6453, 0.95};
    const Look young{0x7C5C4A, 0.9};
    trunk_ = makeTrunkLine(kTrunkHeight, random_);
    const std::array<LimbShape, 2> bough_shapes{
        {{0.036, 0.007, 0.10, 0.016, 0.14, 12, 60}, {0.033, 0.007, 0.05, 0.022, 0.14, 12, 60}}};
    const std::array<LimbShape, 3> branch_shapes{{{0.022, 0.006, 0.07, 0.022, 0.10, 8, 24},
                                                  {0.020, 0.006, -0.05, 0.028, 0.10, 8, 24},
                                                  {0.021, 0.006, 0.11, 0.016, 0.10, 8, 24}}};
    for (const LimbShape& shape : bough_shapes) {
        Limb limb = makeLimb(shape, random_);
        const std::string name = "bough " + std::to_string(boughs_.size() + 1);
        const std::uint32_t id = sample_.add(name, limb.mesh, 0.9, wood);
        boughs_.push_back({std::move(limb), id});
    }
    for (const LimbShape& shape : branch_shapes) {
        Limb limb = makeLimb(shape, random_);
        const std::string name = "branch " + std::to_string(branches_.size() + 1);
        const std::uint32_t id = sample_.add(name, limb.mesh, 0.9, wood);
        branches_.push_back({std::move(limb), id});
    }
    for (int k = 0; k < 3; ++k) {
        twigs_.push_back(makeTwig(k == 1 ? 3 : 2, random_));
        const std::uint32_t id =
            sample_.add("twig " + std::to_string(k + 1), twigs_.back().mesh, 1.3, young);
        twig_limbs_.push_back({{}, id});
    }
    const std::array<LeafShape, 8> shapes{{{1.0, 0.16, 0.30, 0.05, 0.06, true},
                                           {0.9, 0.24, 0.18, 0.12, -0.08, true},
                                           {1.0, -0.08, 0.42, 0.10, 0.10, true},
                                           {0.8, 0.10, 0.34, 0.02, 0.0, true},
                                           {1.0, 0.30, 0.24, 0.0, -0.12, true},
                                           {0.9, -0.05, 0.22, 0.16, 0.05, true},
                                           {1.0, 0.12, 0.50, 0.04, 0.14, true},
                                           {0.7, 0.18, 0.28, 0.08, -0.05, true}}};
    for (std::size_t k = 0; k < shapes.size(); ++k)
        leaves_.push_back(sample_.add("leaf " + std::to_string(k + 1),
                                      makeLeaf(shapes[k], random_),
                                      kPi,
                                      {kLeafColors[k], 0.65, true}));
    seeds_ = sample_.add("winged seeds", makeWingedSeeds(), 1.0, {0xB98A4E, 0.8, true});
}

// Points spread evenly around the crown and over its height; depth 1 is the outside, 0 the axis.
glm::dvec3 MapleBuilder::crownPoint(std::size_t index, std::size_t count, double depth) {
    // Equal steps in height and the golden angle around; the jitter breaks up the spiral.
    const double at = (static_cast<double>(index) + random_.unit()) / static_cast<double>(count);
    const double y = kCrownLow + (kCrownHigh - kCrownLow) * (0.04 + 0.93 * at);
    const double angle = 2.399963 * static_cast<double>(index) + random_.about(0.0, 0.6);
    const double r = crownRadius(y, angle, crown_seed_) * depth;
    return {r * cosine(angle), y, r * sine(angle)};
}

void MapleBuilder::growBoughs() {
    grown_.push_back({&trunk_, Trs{}});
    for (std::size_t i = 0; i < kBoughs; ++i) {
        const double up = static_cast<double>(i) / (kBoughs - 1);
        const double t_height = 1.75 + 3.9 * up * (0.7 + 0.3 * up);
        // The trunk's path is not even in height: search the place.
        double t = 0.0;
        while (t < 1.0 && trunk_.at(t).y < t_height)
            t += 0.005;
        const double angle = 2.399963 * static_cast<double>(i) + random_.about(0.0, 0.25);
        const double rise = 0.42 + 0.75 * up + random_.about(0.0, 0.06);
        const glm::dvec3 heading(cosine(angle), rise, sine(angle));
        const glm::dvec3 from = trunk_.at(t);
        double length = 0.6;
        for (double reach = length; reach < 5.0; reach += 0.05) {
            const glm::dvec3 p = from + glm::normalize(heading) * reach;
            if (glm::length(glm::dvec2(p.x, p.z)) > 0.80 * crownRadius(p.y, angle, crown_seed_))
                break;
            length = reach;
        }
        const LimbKind& kind = boughs_[i % boughs_.size()];
        grown_.push_back(
            {&kind.limb, {from, upright(heading, glm::dvec3(0, 1, 0)), glm::dvec3(length)}});
    }
}

// A limb from the best place on one of the parents to the target: near, growing up and outward,
// forking at a natural angle.
Grown MapleBuilder::attach(const LimbKind& kind,
                           const glm::dvec3& target,
                           double longest,
                           std::span<const Grown> parents) {
    double best = std::numeric_limits<double>::max();
    glm::dvec3 root(0.0);
    for (const Grown& parent : parents)
        for (double t = parent.shape == &trunk_ ? 0.62 : 0.22; t <= 0.96; t += 0.06) {
            const glm::dvec3 from = parent.at(t);
            const double distance = glm::length(target - from);
            const glm::dvec3 heading = (target - from) / std::max(distance, 1e-6);
            const double fork = glm::dot(heading, parent.headingAt(t)); // 1: straight on
            const double cost = distance + 0.5 * std::abs(fork - 0.7) +
                                0.6 * std::max(0.0, -heading.y) + (distance < 0.12 ? 1.0 : 0.0);
            if (cost < best) {
                best = cost;
                root = from;
            }
        }
    const glm::dvec3 heading = target - root;
    const double length = std::clamp(glm::length(heading), 0.15, longest);
    return {&kind.limb, {root, upright(heading, glm::dvec3(0, 1, 0)), glm::dvec3(length)}};
}

void MapleBuilder::growBranches() {
    const std::vector<Grown> parents = grown_;
    for (std::size_t i = 0; i < kBranches; ++i) {
        const glm::dvec3 target = crownPoint(i, kBranches, random_.in(0.62, 0.88));
        grown_.push_back(attach(branches_[i % branches_.size()], target, 1.9, parents));
    }
}

void MapleBuilder::growTwigs() {
    for (std::size_t i = 0; i < kTwigs; ++i) {
        const double depth = 1.0 - 0.42 * random_.unit() * random_.unit();
        const glm::dvec3 target = crownPoint(i, kTwigs, depth);
        const std::size_t kind = i % twigs_.size();
        const Grown grown = attach(twig_limbs_[kind], target, 0.75, grown_);
        Trs trs = grown.trs;
        trs.scale = glm::dvec3(std::clamp(trs.scale.x, 0.35, 0.75));
        twig_at_.push_back(trs);
        twig_kind_.push_back(kind);
    }
}

void MapleBuilder::growLeaves() {
    for (std::size_t w = 0; w < kTwigs; ++w) {
        const std::size_t first = w * kLeaves / kTwigs;
        const std::size_t count = (w + 1) * kLeaves / kTwigs - first;
        const std::vector<Socket>& sockets = twigs_[twig_kind_[w]].sockets;
        const Trs& twig = twig_at_[w];
        const std::size_t skip = random_.below(static_cast<std::uint32_t>(sockets.size()));
        for (std::size_t k = 0; k < count; ++k) {
            const Socket& socket =
                sockets[sockets.size() - 1 - (k + (k == 0 ? 0 : skip)) % sockets.size()];
            const glm::dvec3 at = twig.translation + twig.rotation * (socket.position * twig.scale);
            const glm::dvec3 growing = twig.rotation * socket.direction;
            const glm::dvec3 center(0.0, 4.0, 0.0);
            const glm::dvec3 outward = glm::normalize(at - center);
            const glm::dvec3 forward = glm::normalize(growing * 0.7 + outward * 0.5 +
                                                      glm::dvec3(random_.about(0.0, 0.45),
                                                                 random_.about(-0.35, 0.35),
                                                                 random_.about(0.0, 0.45)));
            const glm::dvec3 facing = glm::dvec3(0.0, 0.85, 0.0) + outward * 0.6 +
                                      glm::dvec3(random_.about(0.0, 0.4),
                                                 random_.about(0.0, 0.3),
                                                 random_.about(0.0, 0.4));
            const double size = random_.in(0.19, 0.30);
            const double warmth = 0.55 * fractalNoise(at * 0.5, crown_seed_ + 7, 2) +
                                  0.35 * (glm::length(at - center) / kCrownRadius - 0.8) +
                                  0.12 * (at.y - 4.5) / 3.0 + random_.about(0.0, 0.34);
            leaf_spots_.push_back({{at, upright(forward, facing), glm::dvec3(size)}, warmth});
        }
        if (w * kSeeds / kTwigs != (w + 1) * kSeeds / kTwigs) {
            const glm::dvec3 at =
                twig.translation + twig.rotation * (sockets[5].position * twig.scale);
            seed_spots_.push_back(
                {at, yaw(random_.in(0.0, 2.0 * kPi)), glm::dvec3(random_.in(0.07, 0.10))});
        }
    }
}

void MapleBuilder::placeLeaves() {
    // Warmest first; each colour takes a fixed, even share, so the counts do not depend on the
    // seed.
    std::ranges::stable_sort(leaf_spots_, std::greater<>(), &LeafSpot::warmth);
    const std::uint32_t group = sample_.addGroup("leaves");
    const std::size_t share = kLeaves / leaves_.size() / 2 * 2;
    for (std::size_t i = 0; i < leaf_spots_.size(); ++i)
        sample_.place(leaves_[std::min(i / share, leaves_.size() - 1)], leaf_spots_[i].trs, group);
}

void MapleBuilder::placeSeeds() {
    const std::uint32_t group = sample_.addGroup("seeds");
    for (const Trs& trs : seed_spots_)
        sample_.place(seeds_, trs, group);
}

ScenePtr MapleBuilder::build() {
    makeParts();
    growBoughs();
    growBranches();
    growTwigs();
    growLeaves();
    const std::uint32_t wood = sample_.addGroup("wood");
    for (std::size_t i = 1; i < grown_.size(); ++i) {
        const std::vector<LimbKind>& kinds = i <= kBoughs ? boughs_ : branches_;
        for (const LimbKind& kind : kinds)
            if (&kind.limb == grown_[i].shape)
                sample_.place(kind.submesh, grown_[i].trs, wood);
    }
    for (std::size_t w = 0; w < kTwigs; ++w)
        sample_.place(twig_limbs_[twig_kind_[w]].submesh, twig_at_[w], wood);
    placeLeaves();
    placeSeeds();
    skinTrunk(trunk_, kTriangles - sample_.triangleCount(), crown_seed_);
    const std::uint32_t trunk = sample_.add("trunk", trunk_.mesh, 0.9, {0x7B6757, 0.95});
    sample_.place(trunk, Trs{}, wood);
    return sample_.finish();
}

} // namespace

ScenePtr makeMaple(std::uint64_t seed) {
    return MapleBuilder(seed).build();
}

} // namespace lodestone::generate
