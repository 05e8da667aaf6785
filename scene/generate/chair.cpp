// A slatted garden armchair. Every number below is in metres; y is up, the sitter looks along +z.
#include "scene/generate/sample.h"

namespace lodestone::generate {

namespace {

// The parts stand at their sizes, so most instances only move and turn.
constexpr double kSeatHeight = 0.42;
constexpr double kHalfWidth = 0.28; // to the middle of a leg
constexpr double kRailX = 0.2395;   // side rails touch the legs
constexpr double kFrontZ = 0.25;
constexpr double kLean = 0.22; // of the back posts, radians
constexpr double kPostLength = 0.98;
constexpr double kSlat = 0.018; // thickness
constexpr double kRailHeight = 0.07;

struct Parts {
    std::uint32_t leg, seat_slat, back_slat, arm, rail, bolt;
};

Parts makeParts(Sample& sample) {
    const Look oiled{0xB07B4A, 0.7};
    const Look frame{0x9C6A3F, 0.7};
    const auto bar = [&](const std::string& name, const BevelledBar& shape, const Look& look) {
        Mesh mesh;
        addBevelledBar(mesh, shape);
        return sample.add(name, mesh, 0.5, look);
    };
    Parts parts{};
    parts.leg = bar("leg", {0.055, 0.045, 0.60, 0.006, 1, {}}, frame);
    // The slats are a little dished: one joint in the middle.
    parts.seat_slat = bar("seat slat", {0.066, kSlat, 0.50, 0.004, 2, {0.0, -0.006}}, oiled);
    parts.back_slat = bar("back slat", {0.052, kSlat, 0.56, 0.004, 2, {0.0, -0.014}}, oiled);
    parts.arm = bar("arm rest", {0.088, 0.024, 0.60, 0.008, 2, {0.008, 0.0}}, oiled);
    parts.rail = bar("cross bar", {kRailHeight, 0.026, 0.505, 0.005, 1, {}}, frame);
    Mesh bolt;
    addTurned(bolt, std::array<glm::dvec2, 2>{{{0.0085, -0.004}, {0.0070, 0.0035}}}, 6);
    parts.bolt = sample.add("bolt", bolt, 0.5, {0x8E8F8C, 0.35});
    return parts;
}

class ChairBuilder {
public:
    explicit ChairBuilder(std::uint64_t seed) : random_(seed), sample_("chair") {
        parts_ = makeParts(sample_);
    }

    ScenePtr build() {
        placeFrame(sample_.addGroup("frame"));
        placeSeat(sample_.addGroup("seat"));
        placeBack(sample_.addGroup("back"));
        return sample_.finish();
    }

private:
    // A bar from `from` along `along`, its broad side facing `facing`.
    void bar(std::uint32_t part,
             const glm::dvec3& from,
             const glm::dvec3& along,
             const glm::dvec3& facing,
             const glm::dvec3& stretch = glm::dvec3(1.0)) {
        sample_.place(part, {from, upright(along, facing), stretch}, group_);
    }

    // Head outwards; no two bolts are turned alike.
    void bolt(const glm::dvec3& at, const glm::dvec3& outward) {
        const glm::dquat turn = upright(outward, glm::dvec3(0.3, 0.2, 1.0));
        sample_.place(parts_.bolt, {at, turn * yaw(random_.in(0.0, kPi)), glm::dvec3(1.0)}, group_);
    }

    // A point of the back posts' middle line, `up` metres along them.
    static glm::dvec3 onPost(double up) { return glm::dvec3(0.0, 0.0, -0.19) + postAxis() * up; }

    static glm::dvec3 postAxis() { return {0.0, cosine(kLean), -sine(kLean)}; }

    static glm::dvec3 postFront() { return {0.0, sine(kLean), cosine(kLean)}; }

    void placeFrame(std::uint32_t group);
    void placeSeat(std::uint32_t group);
    void placeBack(std::uint32_t group);

    Random random_;
    Sample sample_;
    Parts parts_{};
    std::uint32_t group_ = 0;
};

void ChairBuilder::placeFrame(std::uint32_t group) {
    group_ = group;
    const glm::dvec3 up(0, 1, 0);
    const glm::dvec3 front(0, 0, 1);
    const glm::dvec3 right(1, 0, 0);
    const double rail_y = kSeatHeight - kSlat - kRailHeight / 2.0;
    const glm::dvec3 stretch(1.0, kPostLength / 0.60, 1.0);
    for (const double side : {-1.0, 1.0}) {
        const glm::dvec3 x = right * (side * kHalfWidth);
        bar(parts_.leg, x + front * kFrontZ, up, right);
        bar(parts_.leg, x + onPost(0.0), postAxis(), right, stretch);
        // Side rails run inside the legs, and carry the slats.
        const glm::dvec3 from = right * (side * kRailX) + up * rail_y;
        bar(parts_.rail, from + front * -0.285, front, right, {1.0, 0.555 / 0.505, 1.0});
        bolt(glm::dvec3(side * (kHalfWidth + 0.0235), rail_y, kFrontZ), right * side);
        // Arm rests lie on the front legs and are bolted to the back posts.
        const glm::dvec3 arm = right * (side * (kHalfWidth + 0.012)) + up * 0.612;
        bar(parts_.arm, arm + front * (0.30 * side), front * -side, up);
        bolt(arm + glm::dvec3(0.0, 0.0135, kFrontZ), up);
        bolt(arm + glm::dvec3(0.0, 0.0135, -0.27), up);
    }
    const double half = 0.505 / 2.0;
    const std::array<glm::dvec3, 2> aprons{
        {{-half, rail_y, kFrontZ}, {-half, rail_y, onPost(rail_y).z}}};
    for (const glm::dvec3& from : aprons) {
        bar(parts_.rail, from, right, front);
        for (const double side : {-1.0, 1.0})
            bolt(glm::dvec3(side * (kHalfWidth + 0.0235), rail_y + 0.02, from.z), right * side);
    }
}

void ChairBuilder::placeSeat(std::uint32_t group) {
    group_ = group;
    constexpr int kSlats = 7;
    for (int s = 0; s < kSlats; ++s) {
        const double t = static_cast<double>(s) / (kSlats - 1);
        const double z = 0.245 - 0.46 * t;
        const double y = kSeatHeight - 0.028 * t;
        bar(parts_.seat_slat, {-0.25, y, z}, {1, 0, 0}, {0, 1, 0});
        for (const double side : {-1.0, 1.0})
            bolt({side * kRailX, y + 0.011, z}, {0, 1, 0});
    }
}

void ChairBuilder::placeBack(std::uint32_t group) {
    group_ = group;
    constexpr int kSlats = 7;
    const double half = 0.505 / 2.0;
    for (const double up : {0.48, 0.91}) {
        bar(parts_.rail, onPost(up) - glm::dvec3(half, 0, 0), {1, 0, 0}, postFront());
        for (const double side : {-1.0, 1.0})
            bolt(onPost(up) + glm::dvec3(side * (kHalfWidth + 0.0235), 0, 0), {side, 0, 0});
    }
    for (int s = 0; s < kSlats; ++s) {
        const glm::dvec3 x(-0.213 + 0.071 * s, 0.0, 0.0);
        const glm::dvec3 from = x + onPost(0.44) + postFront() * (0.013 + kSlat / 2.0);
        bar(parts_.back_slat, from, postAxis(), postFront());
        for (const double up : {0.48, 0.91})
            bolt(x + onPost(up) + postFront() * (0.013 + kSlat + 0.002), postFront());
    }
}

} // namespace

ScenePtr makeChair(std::uint64_t seed) {
    return ChairBuilder(seed).build();
}

} // namespace lodestone::generate
