// A budget of bytes: the ordering that knows what a step saves against the one for triangles.
#include "scene/generate.h"
#include "simplify/algorithm.h"
#include "simplify/measure/distance.h"

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
    for (const double share : {0.5, 0.2}) {
        const Kept ours = keptOf(*by_byte, bytes, share * whole);
        const Kept theirs = keptOf(*by_triangle, bytes, share * whole);
        EXPECT_LE(static_cast<double>(ours.bytes), share * whole);
        EXPECT_LT(ours.distance.mean, theirs.distance.mean) << "at " << share;
        EXPECT_LE(ours.distance.hausdorff, 1.5 * theirs.distance.hausdorff) << "at " << share;
    }
}

INSTANTIATE_TEST_SUITE_P(Samples,
                         ByteBudget,
                         ::testing::Values("maple", "village"),
                         [](const auto& sample) { return std::string(sample.param); });
