// A budget of bytes: the ordering that knows what a step saves against the one for triangles.
#include "scene/generate.h"
#include "simplify/algorithm.h"
#include "simplify/measure/distance.h"

#include <array>
#include <cmath>
#include <gtest/gtest.h>

using namespace lodestone;

namespace {

struct Kept {
    std::uint64_t bytes = 0;
    Distance distance;
};

Kept keptOf(const LodSource& source, const ByteModel& bytes, double budget) {
    const Resolved resolved = source.resolve({Target::Kind::Bytes, budget}, bytes);
    EXPECT_TRUE(resolved.met) << resolved.note;
    const Lod full = fullLod(*source.scene());
    const Lod lod = source.readOut(resolved.position, nullptr);
    const LodView original{source.scene().get(), &full};
    return {bytes.bytes(source.shapeAt(resolved.position)),
            *measureDistance(original, {source.scene().get(), &lod}, {60'000}, {})};
}

class ByteBudget : public ::testing::TestWithParam<const char*> {};

} // namespace

TEST_P(ByteBudget, IsSpentBetterByTheByteThanByTheTriangle) {
    const ScenePtr scene = *generateScene(GetParam());
    const ByteModel bytes(scene, {});
    const LodSourcePtr by_triangle = *findAlgorithm("ias")->prepare(scene, {}, {}, {});
    const LodSourcePtr by_byte = by_triangle->rescheduled({Ordering::Byte, {}, {}}, bytes);
    const auto whole = static_cast<double>(bytes.bytes(by_triangle->shapeAt(0)));
    // A part's last steps make the maximum jump, in either order at another size: only over several
    // sizes does it say which order is better. The mean is better at each, by how much over all.
    double mean = 1.0; // products of the ratios
    double hausdorff = 1.0;
    constexpr std::array kShares{0.6, 0.5, 0.4, 0.2};
    for (const double share : kShares) {
        const Kept ours = keptOf(*by_byte, bytes, share * whole);
        const Kept theirs = keptOf(*by_triangle, bytes, share * whole);
        EXPECT_LE(static_cast<double>(ours.bytes), share * whole);
        EXPECT_LT(ours.distance.mean, theirs.distance.mean) << "at " << share;
        mean *= ours.distance.mean / theirs.distance.mean;
        hausdorff *= ours.distance.hausdorff / theirs.distance.hausdorff;
    }
    EXPECT_LE(std::pow(mean, 1.0 / kShares.size()), 0.7);
    EXPECT_LE(std::pow(hausdorff, 1.0 / kShares.size()), 1.25);
}

INSTANTIATE_TEST_SUITE_P(Samples,
                         ByteBudget,
                         ::testing::Values("maple", "village"),
                         [](const auto& sample) { return std::string(sample.param); });
