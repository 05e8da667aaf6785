// How scenes and LODs come to the GPU while frames go on. Counts of work, never time.
#include "render/view_set.h"
#include "scene/expand.h"
#include "scene/generate.h"
#include "tests/render/headless_test.h"

#include <algorithm>
#include <chrono>
#include <gtest/gtest.h>
#include <thread>

namespace lodestone {
namespace {

class ViewSetTest : public tests::HeadlessTest {
protected:
    void SetUp() override {
        HeadlessTest::SetUp();
        if (!context_)
            return;
        auto renderer = Renderer::create(*context_);
        ASSERT_TRUE(renderer) << renderer.error().message;
        renderer_.emplace(std::move(*renderer));
        const auto maple = generateScene("maple", 1);
        ASSERT_TRUE(maple) << maple.error().message;
        auto flat = expandScene(**maple, {});
        ASSERT_TRUE(flat) << flat.error().message;
        flat_ = std::move(*flat);
        full_ = std::make_shared<const Lod>(fullLod(*flat_));
        frameCamera(camera_, robustWorldBounds(*flat_), 1.0);
    }

    // Draws until nothing is on its way; the pictures of the last call.
    Result<std::vector<ViewSet::Picture>> arrive(ViewSet& views,
                                                 std::span<const ViewSet::Wanted> wanted) {
        for (;;) {
            auto drawn = views.draw(wanted, camera_, {}, 1e9);
            most_packed_ = std::max(most_packed_, views.lastWork().packed);
            most_copied_ = std::max(most_copied_, views.lastWork().copied_bytes);
            all_copied_ += views.lastWork().copied_bytes;
            ++calls_;
            if (!drawn || std::ranges::none_of(*drawn, &ViewSet::Picture::on_its_way))
                return drawn;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    }

    static constexpr ViewSize kSize{96, 96};
    std::optional<Renderer> renderer_;
    ScenePtr flat_; // 1.8 M unique triangles
    std::shared_ptr<const Lod> full_;
    OrbitCamera camera_;
    std::uint64_t most_packed_ = 0;
    std::uint64_t most_copied_ = 0;
    std::uint64_t all_copied_ = 0;
    int calls_ = 0;
};

TEST_F(ViewSetTest, NoCallPacksOrCopiesMuchWhileALargeSceneArrives) {
    ViewSet views(*renderer_);
    const std::vector<ViewSet::Wanted> wanted{{1, flat_, full_, nullptr, kSize, {}}};
    const auto drawn = arrive(views, wanted);
    ASSERT_TRUE(drawn) << drawn.error().message;
    EXPECT_TRUE(drawn->front().drew && !drawn->front().stale);
    EXPECT_LE(most_packed_, ViewSet::kMostPackedPerCall);
    EXPECT_LE(most_copied_, Delivery::kCopiedPerStep);
    EXPECT_GT(all_copied_, flat_->submeshes.size() * 1000) << "it came some other way";
    EXPECT_GT(calls_, 5) << "in pieces";
}

TEST_F(ViewSetTest, TheLastPictureStaysWhileALargeLodArrives) {
    ViewSet views(*renderer_);
    std::vector<ViewSet::Wanted> wanted{{1, flat_, full_, nullptr, kSize, {}}};
    ASSERT_TRUE(arrive(views, wanted));
    Lod other = *full_;
    for (LodSubmesh& submesh : other.submeshes)
        for (GeometryPtr& geometry : submesh.primitives)
            geometry = std::make_shared<const Geometry>(*geometry); // the same, to be sent again
    wanted[0].lod = std::make_shared<const Lod>(std::move(other));
    const auto waiting = views.draw(wanted, camera_, {}, 1e9);
    ASSERT_TRUE(waiting) << waiting.error().message;
    EXPECT_TRUE(waiting->front().on_its_way && waiting->front().texture != 0);
    const auto there = arrive(views, wanted);
    ASSERT_TRUE(there) << there.error().message;
    EXPECT_TRUE(there->front().drew && !there->front().stale);
}

TEST_F(ViewSetTest, PicksAreOfTheSceneThatIsDrawnWhileAnotherArrives) {
    ViewSet views(*renderer_);
    const auto chair = generateScene("chair", 1);
    ASSERT_TRUE(chair);
    const auto chair_lod = std::make_shared<const Lod>(fullLod(**chair));
    std::vector<ViewSet::Wanted> wanted{{1, *chair, chair_lod, nullptr, kSize, {}}};
    ASSERT_TRUE(arrive(views, wanted));
    EXPECT_EQ(views.pickedScene(1), chair->get());
    EXPECT_EQ(views.pickedScene(2), nullptr) << "no such lane";
    wanted = {{1, flat_, full_, nullptr, kSize, {}}};
    wanted[0].kept_scene = *chair;
    ASSERT_TRUE(views.draw(wanted, camera_, {}, 1e9)->front().on_its_way);
    EXPECT_EQ(views.pickedScene(1), chair->get());
    wanted[0].kept_scene = nullptr;
    ASSERT_TRUE(views.draw(wanted, camera_, {}, 1e9)->front().on_its_way);
    EXPECT_EQ(views.pickedScene(1), nullptr) << "gone from the GPU";
    EXPECT_FALSE(views.pick(1, {0.5, 0.5}));
    ASSERT_TRUE(arrive(views, wanted));
    EXPECT_EQ(views.pickedScene(1), flat_.get());
}

TEST_F(ViewSetTest, ALaneThatGoesWhileItsSceneArrivesIsForgotten) {
    ViewSet views(*renderer_);
    const std::vector<ViewSet::Wanted> wanted{{1, flat_, full_, nullptr, kSize, {}}};
    ASSERT_TRUE(views.draw(wanted, camera_, {}, 1e9)->front().on_its_way);
    EXPECT_TRUE(views.draw({}, camera_, {}, 1e9)->empty());
    const auto again = arrive(views, wanted);
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_TRUE(again->front().drew);
}

} // namespace
} // namespace lodestone
