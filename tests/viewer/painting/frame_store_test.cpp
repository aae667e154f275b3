#include "scene/scene.h"
#include "trace/frame_cache.h"
#include "viewer/editing/missing_frames.h"
#include "viewer/painting/painting.h"
#include "viewer/state/view_state.h"
#include "volume/medium.h"
#include "volume/vdb/vdb.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
// Drifting noise: other fog at every frame.
std::shared_ptr<Scene> noise_scene() {
    Scene scene = *small_scene();
    FogRecipe recipe;
    recipe.bounds = {vec3(-2), vec3(2)}, recipe.voxel_size = 0.25f;
    recipe.wind = vec3(1, 0, 0);
    scene.media[0].kind = MediumKind::noise, scene.media[0].recipe = recipe;
    return std::make_shared<Scene>(std::move(scene));
}

Request playing(const std::shared_ptr<Scene>& scene, int frame) {
    Request request = request_for(scene, "froxel");
    request.revision = static_cast<uint64_t>(frame), request.frame = frame, request.moving = true;
    return request;
}

Snapshot at_frame(const std::shared_ptr<Scene>& scene, int frame) {
    return make_snapshot(*scene, moment_of(*scene, frame));
}

SparseVolume one_voxel() {
    SparseVolume volume;
    volume.active_low = volume.active_high = ivec3(3);
    Leaf& leaf = volume.leaves.emplace_back();
    leaf.values[3 * 73] = 1;
    return volume;
}

// Frames 1 to 5 of a sequence that has 1, 2 and 4.
std::shared_ptr<Scene> scene_with_gap(const TempFolder& directory) {
    for (const char* name : {"smoke.0001.vdb", "smoke.0002.vdb", "smoke.0004.vdb"})
        write_vdb(directory.path() / name, one_voxel());
    Scene scene = *small_scene();
    scene.last_frame = 5;
    scene.media[0].name = "smoke", scene.media[0].kind = MediumKind::vdb;
    scene.media[0].sequence = find_sequence("smoke.####.vdb", directory.path());
    return std::make_shared<Scene>(std::move(scene));
}
}

TEST(FrameStore, FramesThatWereLeftAreTakenUpWithAllThatWasMadeForThem) {
    const auto scene = noise_scene();
    FrameStore store(uint64_t{1} << 40);
    store.begin(scene, MissingFrame::error);
    const Snapshot one = at_frame(scene, 1);
    const auto made = cached(one, "thing", CacheKey().add(7), [] { return 42; });
    store.put(one);
    double seconds = 0;
    EXPECT_FALSE(store.take(2, seconds));
    const auto again = store.take(1, seconds);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->media[0].density.bricks, one.media[0].density.bricks);
    EXPECT_EQ(cached(*again, "thing", CacheKey().add(7), [] { return 43; }), made);
    EXPECT_EQ(seconds, 0);
}

TEST(FrameStore, KeepsNoMoreThanMemoryAllowsAndNothingOfAnotherScene) {
    const auto scene = noise_scene();
    FrameStore none(0), store(uint64_t{1} << 40);
    none.begin(scene, MissingFrame::error), store.begin(scene, MissingFrame::error);
    for (int frame = 1; frame <= 3; ++frame) none.put(at_frame(scene, frame)), store.put(at_frame(scene, frame));
    EXPECT_EQ(none.size(), 0u);
    EXPECT_EQ(store.size(), 3u);
    store.begin(scene, MissingFrame::error);
    EXPECT_EQ(store.size(), 3u);
    store.begin(scene, MissingFrame::hold);
    EXPECT_EQ(store.size(), 0u);
    store.put(at_frame(scene, 1));
    const auto other = noise_scene();
    store.begin(other, MissingFrame::hold);
    EXPECT_EQ(store.size(), 0u);
    store.put(at_frame(scene, 1));
    EXPECT_EQ(store.size(), 0u) << "of a scene that is gone";
}

TEST(FrameStore, TheNextFrameIsMadeAheadOnce) {
    const auto scene = noise_scene();
    FrameStore store(0);
    store.begin(scene, MissingFrame::error);
    const Snapshot one = at_frame(scene, 1);
    EXPECT_TRUE(store.prefetch(2, one));
    EXPECT_FALSE(store.prefetch(2, one));
    double seconds = 0;
    const auto two = store.take(2, seconds);
    ASSERT_TRUE(two);
    EXPECT_EQ(two->frame, 2);
    EXPECT_GT(seconds, 0) << "what it took is told";
    EXPECT_FALSE(store.take(2, seconds));
}

TEST(FrameStore, AFileThatIsMissingIsSaidWhenItsFrameIsAskedFor) {
    const TempFolder directory;
    const auto scene = scene_with_gap(directory);
    FrameStore store;
    store.begin(scene, MissingFrame::error);
    EXPECT_FALSE(store.prefetch(3, at_frame(scene, 2)));
    EXPECT_TRUE(store.prefetch(4, at_frame(scene, 2)));
}

TEST(FrameStore, ALoopIsGrownOnceAndLooksTheSame) {
    const auto scene = noise_scene();
    Painter painter, fresh;
    std::map<int, const BrickPool*> bricks;
    for (int turn = 0; turn < 2; ++turn)
        for (int frame = 1; frame <= 3; ++frame) {
            Request request = playing(scene, frame);
            request.revision += static_cast<uint64_t>(10 * turn);
            ASSERT_TRUE(paint(painter, request, never));
            const BrickPool* now = painter.snapshot.media[0].density.bricks.get();
            if (turn == 0) bricks[frame] = now;
            EXPECT_EQ(now, bricks[frame]) << frame;
        }
    Request still = playing(scene, 3);
    still.revision = 99, still.moving = false, still.mode = "march", still.stand_in.clear();
    paint(painter, still, never), paint(fresh, still, never);
    EXPECT_EQ(paint(painter, still, never)->codes.pixels, paint(fresh, still, never)->codes.pixels);
}

TEST(FrameStore, WhilePlayingThePainterMakesTheNextFrameAfterThePicture) {
    const auto scene = noise_scene();
    Painter painter;
    painter.store = FrameStore(0);
    Request request = playing(scene, 1);
    request.next_frame = 2;
    ASSERT_TRUE(paint(painter, request, never));
    EXPECT_FALSE(paint(painter, request, never)) << "no picture, but the next frame's fog";
    EXPECT_FALSE(painter.store.prefetch(2, painter.snapshot)) << "it is there";
    const auto next = paint(painter, playing(scene, 2), never);
    ASSERT_TRUE(next);
    EXPECT_GT(next->times.load, 0) << "its cost counts for the rate";
}

TEST(MissingFrames, GapsAreListedAndSaid) {
    const TempFolder directory;
    const auto scene = scene_with_gap(directory);
    EXPECT_EQ(missing_frames(*scene), std::vector<int>{3}) << "5 holds the last, which is no gap";
    EXPECT_EQ(missing_text(*scene, 2, MissingFrame::error), "");
    EXPECT_EQ(missing_text(*scene, 3, MissingFrame::error), "a file of smoke is missing at this frame");
    EXPECT_EQ(missing_text(*scene, 3, MissingFrame::hold),
              "a file of smoke is missing at this frame: smoke.0002.vdb is held");
    EXPECT_EQ(missing_text(*scene, 3, MissingFrame::skip), "a file of smoke is missing at this frame: no fog");
    EXPECT_TRUE(missing_frames(*small_scene()).empty());
}

TEST(MissingFrames, ThePolicyIsAnActionAndOtherPictures) {
    const TempFolder directory;
    ViewState state;
    take_scene(state, scene_with_gap(directory));
    EXPECT_EQ(state.gaps, std::vector<int>{3});
    apply(state, parse_action("frame 3"));
    Painter painter;
    EXPECT_NE(paint(painter, request_of(state, false), never)->error.find("missing"), std::string::npos);
    apply(state, parse_action("missing hold"));
    EXPECT_EQ(paint(painter, request_of(state, false), never)->error, "");
    EXPECT_EQ(painter.snapshot.media.size(), 1u);
    apply(state, parse_action("missing skip"));
    EXPECT_EQ(paint(painter, request_of(state, false), never)->error, "");
    EXPECT_TRUE(painter.snapshot.media.empty());
    apply(state, parse_action("missing error"));
    EXPECT_NE(paint(painter, request_of(state, false), never)->error, "");
}
}
