#include "simplify/collapse/removal.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

namespace lodestone {

namespace {

// What the plan needs to know of a submesh.
struct SubmeshFacts {
    Bounds bounds;
    glm::dvec3 pivot{0.0};
    double area = 0.0;
    glm::dmat3 normal_moment{0.0}; // area-weighted mean of n n^T
};

SubmeshFacts factsOf(const Submesh& submesh) {
    SubmeshFacts facts;
    facts.bounds = localBounds(submesh);
    glm::dvec3 centroid(0.0);
    for (const Primitive& primitive : submesh.primitives) {
        if (primitive.mode != PrimitiveMode::Triangles)
            continue;
        const Geometry& geometry = *primitive.geometry;
        for (std::size_t t = 0; t < geometry.triangleCount(); ++t) {
            std::array<glm::dvec3, 3> corner;
            for (std::size_t k = 0; k < 3; ++k)
                corner[k] = glm::dvec3(geometry.positions[geometry.indices[3 * t + k]]);
            const glm::dvec3 cross = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
            const double length = glm::length(cross);
            if (!(length > 0.0))
                continue;
            facts.area += 0.5 * length;
            facts.normal_moment += glm::outerProduct(cross, cross) * (0.5 / length);
            centroid += (corner[0] + corner[1] + corner[2]) * (length / 6.0);
        }
    }
    if (facts.area > 0.0) {
        facts.normal_moment /= facts.area;
        centroid /= facts.area;
    }
    // The submesh's own origin if it lies in or near its box (a leaf's stalk), else its centroid.
    const glm::dvec3 margin(0.1 * facts.bounds.diagonal());
    const bool near = glm::all(glm::lessThanEqual(facts.bounds.min - margin, glm::dvec3(0.0))) &&
                      glm::all(glm::greaterThanEqual(facts.bounds.max + margin, glm::dvec3(0.0)));
    facts.pivot = near ? glm::dvec3(0.0) : centroid;
    return facts;
}

// World area of an instance: sqrt of the mean of |C n|^2, exact for similarities.
double instanceArea(const SubmeshFacts& facts, const glm::dmat3& m) {
    const glm::dmat3 cofactor(
        glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    const glm::dmat3 gram = glm::transpose(cofactor) * cofactor;
    const glm::dmat3 product = gram * facts.normal_moment;
    return facts.area * std::sqrt(std::max(0.0, product[0][0] + product[1][1] + product[2][2]));
}

std::uint64_t spread(std::uint64_t v) { // 21 bits to every third bit
    v &= 0x1FFFFF;
    v = (v | v << 32) & 0x1F00000000FFFF;
    v = (v | v << 16) & 0x1F0000FF0000FF;
    v = (v | v << 8) & 0x100F00F00F00F00F;
    v = (v | v << 4) & 0x10C30C30C30C30C3;
    return (v | v << 2) & 0x1249249249249249;
}

std::uint64_t mortonOf(const glm::dvec3& p, const Bounds& bounds) {
    std::uint64_t code = 0;
    const double size = std::max({bounds.size().x, bounds.size().y, bounds.size().z, 1e-300});
    for (int axis = 0; axis < 3; ++axis) {
        const double unit = std::clamp((p[axis] - bounds.min[axis]) / size, 0.0, 1.0);
        code |= spread(static_cast<std::uint64_t>(unit * 0x1FFFFF)) << axis;
    }
    return code;
}

struct Member {
    std::uint32_t instance = 0;
    glm::dvec3 at{0.0}; // pivot in the world
    double reach = 0.0; // farthest a corner of its box is from `at`
    double room = 0.0;  // growth up to which its box surely stays inside the model's
    double area = 0.0;
    std::uint64_t code = 0;
};

std::vector<Member> membersOf(const Scene& scene,
                              InstanceRange range,
                              const SubmeshFacts& facts,
                              const Bounds& scene_bounds) {
    std::vector<Member> members(range.size());
    Bounds spots;
    for (std::uint32_t i = 0; i < range.size(); ++i) {
        Member& member = members[i];
        member.instance = range.begin + i;
        const glm::dmat4& transform = scene.instances[member.instance].transform;
        member.at = glm::dvec3(transform * glm::dvec4(facts.pivot, 1.0));
        member.area = instanceArea(facts, glm::dmat3(transform));
        member.room = std::numeric_limits<double>::infinity();
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 local((corner & 1) ? facts.bounds.max.x : facts.bounds.min.x,
                                   (corner & 2) ? facts.bounds.max.y : facts.bounds.min.y,
                                   (corner & 4) ? facts.bounds.max.z : facts.bounds.min.z);
            const glm::dvec3 arm = glm::dvec3(transform * glm::dvec4(local, 1.0)) - member.at;
            for (int axis = 0; axis < 3; ++axis) {
                const double wall = arm[axis] > 0.0 ? scene_bounds.max[axis] - member.at[axis]
                                                    : member.at[axis] - scene_bounds.min[axis];
                if (std::abs(arm[axis]) > 0.0)
                    member.room = std::min(member.room, wall / std::abs(arm[axis]));
            }
        }
        spots.add(member.at);
    }
    for (Member& member : members)
        member.code = mortonOf(member.at, spots);
    std::ranges::sort(members, [](const Member& a, const Member& b) {
        return a.code != b.code ? a.code < b.code : a.instance < b.instance;
    });
    return members;
}

std::size_t reversedBits(std::size_t value, int bits) {
    std::size_t reversed = 0;
    for (int b = 0; b < bits; ++b)
        reversed |= (value >> b & 1) << (bits - 1 - b);
    return reversed;
}

// Indices into members, the first to go first. Rounds halve the survivors: neighbours along the
// Morton curve are a stratum of two, of which one goes; the strata of a round go in bit-reversed
// order, so that every moment of the slider is evenly thinned.
std::vector<std::uint32_t> removalOrder(const std::vector<Member>& members) {
    std::vector<std::uint32_t> alive(members.size());
    std::iota(alive.begin(), alive.end(), 0u);
    std::vector<std::uint32_t> order;
    double growth = 1.0;
    for (int round = 0; alive.size() > 1; ++round) {
        growth = std::min(kMaxGrowth, growth * std::sqrt(2.0));
        const std::size_t pairs = alive.size() / 2;
        const int bits = static_cast<int>(std::bit_width(pairs - 1));
        std::vector<std::uint32_t> survivors(alive.begin() + static_cast<std::ptrdiff_t>(2 * pairs),
                                             alive.end());
        std::vector<std::uint32_t> stay(pairs);
        for (std::size_t slot = 0; slot < std::size_t{1} << bits; ++slot) {
            const std::size_t pair = reversedBits(slot, bits);
            if (pair >= pairs)
                continue;
            const std::uint32_t a = alive[2 * pair];
            const std::uint32_t b = alive[2 * pair + 1];
            const bool a_fits = members[a].room >= growth;
            const bool b_fits = members[b].room >= growth;
            const bool keep_a =
                a_fits != b_fits ? a_fits : ((pair + static_cast<std::size_t>(round)) & 1) == 0;
            stay[pair] = keep_a ? a : b;
            order.push_back(keep_a ? b : a);
        }
        survivors.insert(survivors.begin(), stay.begin(), stay.end());
        alive = std::move(survivors);
    }
    order.insert(order.end(), alive.begin(), alive.end());
    return order;
}

// Distance of each newcomer to the nearest point already there: a dense grid over known bounds that
// is rebuilt finer whenever the number of points has doubled, so that a cell holds about one.
class GrowingGrid {
public:
    explicit GrowingGrid(const Bounds& bounds) : bounds_(bounds) { rebuild(); }

    double nearest(const glm::dvec3& p) const {
        const glm::ivec3 center = cellOf(p);
        double best2 = std::numeric_limits<double>::infinity();
        const int rings = std::max({size_.x, size_.y, size_.z});
        for (int ring = 0; ring < rings; ++ring) {
            const double safe = static_cast<double>(ring - 1) * cell_; // all nearer cells are done
            if (ring > 0 && best2 <= safe * safe)
                break;
            forShell(center, ring, [&](std::uint32_t id) {
                const glm::dvec3 apart = points_[id] - p;
                best2 = std::min(best2, glm::dot(apart, apart));
            });
        }
        return std::sqrt(best2);
    }

    void add(const glm::dvec3& p) {
        points_.push_back(p);
        next_.push_back(kNone);
        if (points_.size() >= 2 * built_for_)
            rebuild();
        else
            insert(static_cast<std::uint32_t>(points_.size() - 1));
    }

private:
    glm::ivec3 cellOf(const glm::dvec3& p) const {
        const glm::ivec3 cell(glm::floor((p - bounds_.min) / cell_));
        return glm::clamp(cell, glm::ivec3(0), size_ - 1);
    }

    std::size_t indexOf(int x, int y, int z) const {
        return (static_cast<std::size_t>(z) * static_cast<std::size_t>(size_.y) +
                static_cast<std::size_t>(y)) *
                   static_cast<std::size_t>(size_.x) +
               static_cast<std::size_t>(x);
    }

    // Cells exactly `ring` away along the farthest axis.
    template <class Visit>
    void forShell(const glm::ivec3& center, int ring, Visit visit) const {
        const glm::ivec3 low = glm::max(center - ring, glm::ivec3(0));
        const glm::ivec3 high = glm::min(center + ring, size_ - 1);
        for (int z = low.z; z <= high.z; ++z)
            for (int y = low.y; y <= high.y; ++y) {
                const bool face = std::abs(z - center.z) == ring || std::abs(y - center.y) == ring;
                const int step = face || ring == 0 ? 1 : 2 * ring; // else only both ends
                for (int x = face ? low.x : center.x - ring; x <= high.x; x += step)
                    if (x >= 0)
                        for (std::uint32_t id = heads_[indexOf(x, y, z)]; id != kNone;
                             id = next_[id])
                            visit(id);
            }
    }

    void insert(std::uint32_t id) {
        const glm::ivec3 cell = cellOf(points_[id]);
        std::uint32_t& head = heads_[indexOf(cell.x, cell.y, cell.z)];
        next_[id] = head;
        head = id;
    }

    void rebuild() {
        built_for_ = std::max<std::size_t>(points_.size(), 8);
        const double longest =
            std::max({bounds_.size().x, bounds_.size().y, bounds_.size().z, 1e-300});
        // Flat and long clouds use their cells as well as round ones.
        cell_ = longest / static_cast<double>(built_for_);
        const auto along = [&](double length) { return std::floor(length / cell_) + 1.0; };
        const auto cells = [&] {
            return along(bounds_.size().x) * along(bounds_.size().y) * along(bounds_.size().z);
        };
        while (cells() > static_cast<double>(built_for_))
            cell_ *= 1.25;
        size_ =
            glm::ivec3(along(bounds_.size().x), along(bounds_.size().y), along(bounds_.size().z));
        heads_.assign(static_cast<std::size_t>(cells()), kNone);
        for (std::uint32_t id = 0; id < points_.size(); ++id)
            insert(id);
    }

    Bounds bounds_;
    double cell_ = 1.0;
    glm::ivec3 size_{1};
    std::size_t built_for_ = 8;
    std::vector<glm::dvec3> points_;
    std::vector<std::uint32_t> heads_; // [cells] first point
    std::vector<std::uint32_t> next_;  // [points] in the same cell
};

} // namespace

double growthAt(const RemovalSequence& removal, std::uint32_t kept) {
    const double all = removal.area_left.back();
    const double left = removal.area_left[kept];
    if (!(left > 0.0) || kept + 1 >= removal.area_left.size())
        return 1.0;
    return std::min(kMaxGrowth, std::sqrt(all / left));
}

RemovalSequence planRemoval(const Scene& scene,
                            std::uint32_t submesh,
                            InstanceRange range,
                            const Bounds& scene_bounds) {
    if (triangleCount(scene.submeshes[submesh]) == 0) // points and lines gain nothing by going
        return {};
    const SubmeshFacts facts = factsOf(scene.submeshes[submesh]);
    const std::vector<Member> members = membersOf(scene, range, facts, scene_bounds);
    std::vector<std::uint32_t> order = removalOrder(members);
    std::ranges::reverse(order); // the longest-lived first
    RemovalSequence removal;
    removal.pivot = facts.pivot;
    removal.area_left.push_back(0.0);
    auto instances = std::make_shared<std::vector<std::uint32_t>>();
    std::vector<double> distance;
    Bounds spots;
    for (const Member& member : members)
        spots.add(member.at);
    GrowingGrid grid(spots);
    for (const std::uint32_t index : order) {
        const Member& member = members[index];
        instances->push_back(member.instance);
        removal.area_left.push_back(removal.area_left.back() + member.area);
        distance.push_back(grid.nearest(member.at));
        grid.add(member.at);
    }
    double running = 0.0;
    double running_distance = 0.0;
    for (std::size_t i = order.size(); i-- > 1;) { // from the first to go
        running_distance = std::max(running_distance, distance[i]);
        running = std::max(running, members[order[i]].area * running_distance * running_distance);
        removal.cost.push_back(running);
        removal.error.push_back(static_cast<float>(running_distance));
    }
    removal.order = std::move(instances);
    return removal;
}

} // namespace lodestone
