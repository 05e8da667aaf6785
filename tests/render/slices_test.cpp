// Pictures that are drawn over several calls.
#include "render/gl_context.h"
#include "render/renderer.h"
#include "render/slice_pace.h"
#include "render/view.h"
#include "render/view_set.h"
#include "scene/generate.h"
#include "tests/render/headless_test.h"

#include <gtest/gtest.h>

namespace lodestone {
namespace {

class SlicesTest : public tests::HeadlessTest {
protected:
    void SetUp() override {
        HeadlessTest::SetUp();
        if (!context_)
            return;
        if (!context_->info().is_software)
            GTEST_SKIP() << "only software renderers draw in slices";
        auto renderer = Renderer::create(*context_);
        ASSERT_TRUE(renderer) << renderer.error().message;
        renderer_.emplace(std::move(*renderer));
        auto scene = generateScene("maple", 1);
        ASSERT_TRUE(scene) << scene.error().message;
        scene_ = *scene;
        camera_.distance = 40.0;
        frameCamera(camera_, robustWorldBounds(*scene_), 1.0);
    }

    static constexpr ViewSize kSize{160, 160};
    std::optional<Renderer> renderer_;
    ScenePtr scene_;
    OrbitCamera camera_;
};

TEST_F(SlicesTest, ManySlicesGiveThePictureOfOneDraw) {
    auto gpu = GpuScene::create(*renderer_, scene_);
    ASSERT_TRUE(gpu) << gpu.error().message;
    LodHandle lod;
    ASSERT_TRUE(gpu->update(lod, fullLod(*scene_)));
    const View::Input input{&*gpu, &lod, camera_, {}, kSize};
    auto whole = View::create(*renderer_);
    auto sliced = View::create(*renderer_);
    ASSERT_TRUE(whole && sliced);
    const auto once = whole->draw(input);
    ASSERT_TRUE(once) << once.error().message;
    int calls = 0;
    Result<DrawReport> last = DrawReport{};
    do {
        last = sliced->draw(input, 0.0);
        ASSERT_TRUE(last) << last.error().message;
        ASSERT_LT(++calls, 1000);
    } while (!last->complete);
    EXPECT_GT(calls, 3);
    EXPECT_TRUE(last->drew);
    EXPECT_EQ(last->triangles, once->triangles);
    EXPECT_EQ(whole->readPixels()->rgba, sliced->readPixels()->rgba);
    const auto again = sliced->draw(input, 0.0);
    ASSERT_TRUE(again);
    EXPECT_TRUE(again->complete && !again->drew);
}

TEST_F(SlicesTest, HighlightsOfEverythingAreDrawnInSlicesToo) {
    auto gpu = GpuScene::create(*renderer_, scene_);
    ASSERT_TRUE(gpu) << gpu.error().message;
    LodHandle lod;
    ASSERT_TRUE(gpu->update(lod, fullLod(*scene_)));
    View::Input input{&*gpu, &lod, camera_, {}, kSize};
    const auto callsOf = [&](View& view) {
        int calls = 1;
        while (!view.draw(input, 0.0)->complete)
            ++calls;
        return calls;
    };
    auto plain = View::create(*renderer_);
    auto whole = View::create(*renderer_);
    auto sliced = View::create(*renderer_);
    ASSERT_TRUE(plain && whole && sliced);
    const int plain_calls = callsOf(*plain);
    for (std::uint32_t s = 0; s < scene_->submeshes.size(); ++s)
        input.options.highlighted.push_back({s, kNone});
    input.options.grid = true;
    EXPECT_GT(callsOf(*sliced), plain_calls + 3);
    ASSERT_TRUE(whole->draw(input));
    EXPECT_EQ(whole->readPixels()->rgba, sliced->readPixels()->rgba);
}

TEST_F(SlicesTest, AnotherCameraStartsThePictureAgain) {
    auto gpu = GpuScene::create(*renderer_, scene_);
    ASSERT_TRUE(gpu) << gpu.error().message;
    LodHandle lod;
    ASSERT_TRUE(gpu->update(lod, fullLod(*scene_)));
    View::Input input{&*gpu, &lod, camera_, {}, kSize};
    auto whole = View::create(*renderer_);
    auto sliced = View::create(*renderer_);
    ASSERT_TRUE(whole && sliced);
    ASSERT_FALSE(sliced->draw(input, 0.0)->complete);
    orbitCamera(input.camera, 1.0, 0.2);
    while (!sliced->draw(input, 0.0)->complete) {
    }
    ASSERT_TRUE(whole->draw(input));
    EXPECT_EQ(whole->readPixels()->rgba, sliced->readPixels()->rgba);
}

TEST_F(SlicesTest, APictureUnderWayIsFinishedWhileTheCameraMovesOn) {
    ViewSet views(*renderer_);
    const auto full = std::make_shared<const Lod>(fullLod(*scene_));
    const std::vector<ViewSet::Wanted> wanted{{1, scene_, full, nullptr, kSize, {}}};
    int calls = 0;
    int pictures = 0;
    bool stale = true;
    OrbitCamera camera = camera_;
    while (pictures < 2) {
        orbitCamera(camera, 0.5, 0.0);
        const auto drawn = views.draw(wanted, camera, {}, 0.0);
        ASSERT_TRUE(drawn) << drawn.error().message;
        pictures += drawn->front().drew ? 1 : 0;
        stale = drawn->front().stale;
        calls += drawn->front().on_its_way ? 0 : 1;
        ASSERT_LT(calls, 2000);
    }
    EXPECT_GT(calls, 10) << "it was not drawn in slices";
    EXPECT_TRUE(stale) << "the camera was elsewhere";
    const auto finish = [&](ViewSet& set, double budget_ms) {
        auto drawn = set.draw(wanted, camera, {}, budget_ms);
        while (drawn && drawn->front().stale)
            drawn = set.draw(wanted, camera, {}, budget_ms);
        return drawn.has_value();
    };
    ViewSet at_once(*renderer_);
    ASSERT_TRUE(finish(views, 0.0) && finish(at_once, 1e9));
    EXPECT_EQ(views.readPixels(1)->rgba, at_once.readPixels(1)->rgba);
}

TEST(SlicePaceTest, SlicesShrinkAtOnceAndGrowByAndBy) {
    SlicePace pace;
    const std::uint64_t first = pace.trianglesWithin(SlicePace::kSliceMs);
    pace.drew(first, 8.0 * SlicePace::kSliceMs); // the machine is busy
    const std::uint64_t busy = pace.trianglesWithin(SlicePace::kSliceMs);
    EXPECT_EQ(busy, first / 8);
    EXPECT_LT(pace.trianglesWithin(0.5 * SlicePace::kSliceMs), busy);
    pace.drew(busy, 0.125 * SlicePace::kSliceMs); // it is not any more
    const std::uint64_t more = pace.trianglesWithin(SlicePace::kSliceMs);
    EXPECT_GT(more, busy);
    EXPECT_LT(more, first);
}

TEST(SlicePaceTest, ThereIsAlwaysASliceAndNeverAHugeOne) {
    SlicePace pace;
    EXPECT_EQ(pace.trianglesWithin(-1.0), SlicePace::kFewest);
    EXPECT_LE(pace.trianglesWithin(1e9), SlicePace::kMost);
    pace.drew(SlicePace::kMost, 0.0); // as quick as a clock can tell
    EXPECT_EQ(pace.trianglesWithin(SlicePace::kSliceMs), SlicePace::kMost);
    pace.drew(SlicePace::kMost, 1e9);
    EXPECT_EQ(pace.trianglesWithin(1e9), SlicePace::kFewest);
}

TEST_F(SlicesTest, ADraftIsShownUntilItIsNoLongerWanted) {
    ViewSet views(*renderer_);
    const auto full = std::make_shared<const Lod>(fullLod(*scene_));
    Lod few = *full;
    for (LodSubmesh& submesh : few.submeshes)
        submesh.kept_instances = 1;
    const auto draft = std::make_shared<const Lod>(std::move(few));
    std::vector<ViewSet::Wanted> wanted{{1, scene_, full, draft, kSize, {}}};
    auto drawn = views.draw(wanted, camera_, {}, 1e9);
    while (drawn && drawn->front().on_its_way)
        drawn = views.draw(wanted, camera_, {}, 1e9);
    ASSERT_TRUE(drawn) << drawn.error().message;
    EXPECT_TRUE(drawn->front().draft && drawn->front().drew && !drawn->front().stale);
    drawn = views.draw(wanted, camera_, {}, 1e9);
    ASSERT_TRUE(drawn);
    EXPECT_FALSE(drawn->front().drew) << "nothing changed";
    wanted[0].draft = nullptr;
    drawn = views.draw(wanted, camera_, {}, 1e9);
    ASSERT_TRUE(drawn);
    EXPECT_TRUE(!drawn->front().draft && drawn->front().drew && !drawn->front().stale);
}

} // namespace
} // namespace lodestone
