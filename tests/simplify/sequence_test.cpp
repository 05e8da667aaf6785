#include "tests/simplify/meshes.h"

#include <gtest/gtest.h>

namespace lodestone {

namespace {

using meshes::readAt;
using meshes::sequenceOf;
using meshes::submeshOf;

// One of each: attributes, several primitives and components, doubles, unused vertices.
Submesh mixedSubmesh() {
    const GeometryPtr ball = meshes::sphere(8, 10);
    std::vector<float> normals;
    for (const glm::vec3& p : ball->positions)
        normals.insert(normals.end(), {p.x, p.y, p.z});
    auto messy = std::make_shared<Geometry>(*meshes::grid(6));
    messy->indices.insert(messy->indices.end(), {0, 0, 1, 3, 4, 3}); // degenerate
    messy->positions.emplace_back(0.5f, 0.5f, 0.5f);                 // unused
    return submeshOf({meshes::withAttribute(*ball, "NORMAL", normals),
                      messy,
                      meshes::soup(20),
                      meshes::moved(meshes::sphere(5, 6), {3.0, 0.0, 0.0})});
}

void expectSame(const Geometry& a, const Geometry& b) {
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.indices, b.indices);
    ASSERT_EQ(a.attributes.size(), b.attributes.size());
    for (std::size_t i = 0; i < a.attributes.size(); ++i)
        EXPECT_EQ(a.attributes[i].bytes, b.attributes[i].bytes);
}

// Replays the steps one by one: which vertex stands for which, kept up to date.
class Replay {
public:
    Replay(const CollapseSequence& sequence, const Submesh& submesh)
        : sequence_(sequence), submesh_(submesh),
          stands_for_(sequence.complex.wedge_source.size()) {
        for (std::uint32_t w = 0; w < stands_for_.size(); ++w)
            stands_for_[w] = w;
    }

    void advance() {
        ++step_;
        for (std::uint32_t& wedge : stands_for_)
            while (sequence_.wedge_death[wedge] == step_ && sequence_.wedge_parent[wedge] != kNone)
                wedge = sequence_.wedge_parent[wedge];
    }

    std::vector<glm::vec3> corners() const {
        std::vector<glm::vec3> all;
        for (std::size_t f = 0; f < sequence_.complex.faces.size(); ++f)
            if (sequence_.face_death[f] > step_)
                for (const std::uint32_t wedge : sequence_.complex.faces[f])
                    all.push_back(wedgePosition(sequence_, submesh_, stands_for_[wedge], step_));
        return all;
    }

private:
    const CollapseSequence& sequence_;
    const Submesh& submesh_;
    std::vector<std::uint32_t> stands_for_;
    std::uint32_t step_ = 0;
};

std::vector<glm::vec3> cornersOf(std::span<const GeometryPtr> primitives) {
    std::vector<glm::vec3> all;
    for (const GeometryPtr& geometry : primitives)
        for (const std::uint32_t index : geometry->indices)
            all.push_back(geometry->positions[index]);
    return all;
}

} // namespace

TEST(Sequence, ReadOutEqualsTheReplayOfItsSteps) {
    const Submesh submesh = mixedSubmesh();
    const CollapseSequence sequence = sequenceOf(submesh);
    Replay replay(sequence, submesh);
    for (std::uint32_t step = 1; step <= sequence.step_count; ++step) {
        replay.advance();
        ASSERT_EQ(cornersOf(readAt(sequence, submesh, step)), replay.corners()) << "step " << step;
    }
}

TEST(Sequence, CountsEqualTheReadOutAtEveryStep) {
    const Submesh submesh = mixedSubmesh();
    const CollapseSequence sequence = sequenceOf(submesh);
    for (std::uint32_t step = 1; step <= sequence.step_count; ++step) {
        const std::vector<GeometryPtr> primitives = readAt(sequence, submesh, step);
        std::uint32_t faces = 0;
        for (std::size_t p = 0; p < primitives.size(); ++p) {
            ASSERT_EQ(primitives[p]->triangleCount(), sequence.counts[p].faces[step]);
            ASSERT_EQ(primitives[p]->positions.size(), sequence.counts[p].wedges[step]);
            faces += sequence.counts[p].faces[step];
        }
        ASSERT_EQ(sequence.facesAt(step), faces);
    }
}

TEST(Sequence, EveryVertexThatIsReadOutIsUsed) {
    const Submesh submesh = mixedSubmesh();
    const CollapseSequence sequence = sequenceOf(submesh);
    for (std::uint32_t step = 1; step <= sequence.step_count; step += 7)
        for (const GeometryPtr& geometry : readAt(sequence, submesh, step)) {
            std::vector<bool> used(geometry->positions.size(), false);
            for (const std::uint32_t index : geometry->indices) {
                ASSERT_LT(index, used.size());
                used[index] = true;
            }
            EXPECT_EQ(std::count(used.begin(), used.end(), false), 0) << "step " << step;
        }
}

TEST(Sequence, CleaningIsAStepOfItsOwnAndFree) {
    const Submesh submesh = mixedSubmesh();
    const CollapseSequence sequence = sequenceOf(submesh);
    EXPECT_EQ(sequence.complex.dropped_faces, 2u);
    EXPECT_EQ(sequence.facesAt(0), triangleCount(submesh));
    EXPECT_EQ(sequence.facesAt(1), triangleCount(submesh) - 2);
    EXPECT_EQ(sequence.cost[0], 0.0);
}

TEST(Sequence, StepsOfAllComponentsComeByRisingCost) {
    const Submesh submesh =
        submeshOf({meshes::sphere(8, 10), meshes::moved(meshes::sphere(8, 10), {5.0, 0.0, 0.0})});
    const CollapseSequence sequence = sequenceOf(submesh);
    // Twins collapse side by side, but for the few steps that wait behind a dear one.
    for (std::uint32_t step = 0; step <= sequence.step_count; ++step)
        EXPECT_LE(std::abs(static_cast<int>(sequence.counts[0].faces[step]) -
                           static_cast<int>(sequence.counts[1].faces[step])),
                  12)
            << "step " << step;
}

TEST(Sequence, IsTheSameWhateverElseIsBuiltBesideIt) {
    const Submesh submesh = mixedSubmesh();
    const Submesh other = submeshOf({meshes::sphere(20, 30)});
    std::vector<SequenceRequest> requests(3);
    requests[0].submesh = &other;
    requests[1].submesh = &submesh;
    requests[2].submesh = &other;
    const auto together = buildSequences(requests, {}, {}, {});
    ASSERT_TRUE(together);
    const CollapseSequence alone = sequenceOf(submesh);
    EXPECT_EQ((*together)[1].cost, alone.cost);
    for (const std::uint32_t step : {alone.step_count / 3, alone.step_count}) {
        const auto a = readAt(alone, submesh, step);
        const auto b = readAt((*together)[1], submesh, step);
        for (std::size_t p = 0; p < a.size(); ++p)
            expectSame(*a[p], *b[p]);
    }
}

TEST(Sequence, EqualVerticesAreOneAfterReadOut) {
    auto corners = std::make_shared<Geometry>(); // every corner its own vertex
    const GeometryPtr shared = meshes::sphere(8, 10);
    for (const std::uint32_t index : shared->indices) {
        corners->indices.push_back(static_cast<std::uint32_t>(corners->positions.size()));
        corners->positions.push_back(shared->positions[index]);
    }
    const Submesh apart = submeshOf({corners});
    const Submesh together = submeshOf({shared});
    const CollapseSequence a = sequenceOf(apart);
    const CollapseSequence b = sequenceOf(together);
    EXPECT_EQ(a.cost.size(), b.cost.size());
    EXPECT_EQ(a.counts[0].wedges, b.counts[0].wedges);
}

TEST(Sequence, WeldBlocksStayApart) {
    auto two = std::make_shared<Geometry>(*meshes::card(4)); // both layers on the same positions
    const Submesh welded = submeshOf({two});
    auto apart = std::make_shared<Geometry>(*two);
    apart->weld_blocks = {0, 25};
    EXPECT_EQ(sequenceOf(welded).complex.componentCount(), 1u);
    EXPECT_EQ(sequenceOf(submeshOf({apart})).complex.componentCount(), 2u);
}

} // namespace lodestone
