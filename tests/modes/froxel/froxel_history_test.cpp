// What froxels remember of the frames before.
#include "modes/froxel/history/froxel_history.h"
#include "modes/froxel/settings.h"

#include "modes/froxel/froxel_fixtures.h"
#include "modes/history.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
TestScene lit_stage(bool lamp = true) {
    std::vector<Light> lights{sun_light({0.3f, -1, 0.1f}, 0.1f)};
    if (lamp) lights.push_back(point_light({0.5f, 4.5f, 0}, 40));
    return make_scene({homogeneous_medium(0.2f, {vec3(-3), vec3(3)})}, lights,
                      {quad({-50, 3, -50}, {50, 0, 0}, {0, 0, 100}), box_of({-0.5f, -1, -0.5f}, {0, 0.5f, 0})});
}

View moved_view(int frame) {
    View view = view_of({0.02f * static_cast<float>(frame), 0.5f, 6}, {0, 0, 0});
    view.frame = frame;
    return view;
}

std::vector<Scatter> picture(const View& view, const Snapshot& snapshot, const Settings& settings, History* history) {
    return scattered(froxels(view, snapshot, settings, history), pixel_rays(view, snapshot, 12));
}

class WithHistory : public testing::TestWithParam<std::tuple<bool, FroxelVisibility>> {
protected:
    Settings settings() const {
        Settings result;
        result.of<FroxelSettings>().tile = 2;
        result.of<FroxelSettings>().amortize = std::get<0>(GetParam()),
        result.of<FroxelSettings>().visibility = std::get<1>(GetParam());
        return as_wide(result, view_of({}, {0, 0, -1}).size);
    }
};

TEST_P(WithHistory, StartsAsIfThereWereNoneAlsoAfterACut) {
    const TestScene stage = lit_stage();
    History history;
    for (int frame = 0; frame < 3; ++frame) picture(moved_view(frame), stage.snapshot, settings(), &history);
    View cut = moved_view(3);
    cut.camera = look_at({5, 1, 2}, {0, 0, 0}, {0, 1, 0}, 0.8f);
    const auto after = picture(cut, stage.snapshot, settings(), &history);
    const auto fresh = picture(cut, stage.snapshot, settings(), nullptr);
    for (size_t i = 0; i < after.size(); ++i) {
        ASSERT_EQ(after[i].radiance, fresh[i].radiance);
        ASSERT_EQ(after[i].transmittance, fresh[i].transmittance);
    }
}

TEST_P(WithHistory, ALightSwitchedOffIsForgotten) {
    TestScene stage = lit_stage(true);
    const TestScene dark = lit_stage(false);
    History history;
    double before = 0;
    for (int frame = 0; frame < 8; ++frame)
        before = mean_of(picture(moved_view(frame), stage.snapshot, settings(), &history));
    Snapshot off = stage.snapshot;
    off.lights.pop_back();
    double after = 0;
    for (int frame = 8; frame < 12; ++frame) after = mean_of(picture(moved_view(frame), off, settings(), &history));
    const double without = mean_of(picture(moved_view(11), dark.snapshot, settings(), nullptr));
    EXPECT_LT(std::abs(after - without), 0.02 * (before - without));
}

TEST_P(WithHistory, ANaNIsGoneInTheNextFrame) {
    const TestScene stage = lit_stage();
    History history;
    picture(moved_view(0), stage.snapshot, settings(), &history);
    auto poisoned = std::make_shared<FroxelHistory>(*history.froxels);
    for (size_t i = 0; i < poisoned->light.values.size(); i += 37)
        poisoned->light.values[i] = std::numeric_limits<float>::quiet_NaN();
    history.froxels = poisoned;
    ASSERT_GT(poisoned->light.values.size(), 37u);
    for (const Scatter& result : picture(moved_view(1), stage.snapshot, settings(), &history))
        ASSERT_TRUE(is_finite(result.radiance) && std::isfinite(result.transmittance));
    EXPECT_EQ(history.froxels->light.values.size(), poisoned->light.values.size());
    for (const float value : history.froxels->light.values) ASSERT_TRUE(std::isfinite(value));
}

TEST_P(WithHistory, TwoThatGoOnFromOneSeeTheSame) {
    // The camera stands and the fog drifts: what is remembered is taken over unless another history needs it too.
    TestScene stage = lit_stage();
    History history;
    for (int frame = 0; frame < 3; ++frame) picture(moved_view(0), stage.snapshot, settings(), &history);
    stage.snapshot.media[0].optics.extinction *= 1.1f;
    picture(moved_view(0), stage.snapshot, settings(), &history);
    History other = history;
    const std::vector<float> before(other.froxels->light.values.begin(), other.froxels->light.values.end());
    stage.snapshot.media[0].optics.extinction *= 1.1f;
    const auto first = picture(moved_view(0), stage.snapshot, settings(), &history);
    EXPECT_TRUE(std::ranges::equal(other.froxels->light.values, before));
    const auto second = picture(moved_view(0), stage.snapshot, settings(), &other);
    for (size_t i = 0; i < first.size(); ++i) {
        ASSERT_EQ(first[i].radiance, second[i].radiance);
        ASSERT_EQ(first[i].transmittance, second[i].transmittance);
    }
}

TEST_P(WithHistory, StaysCloseToTheReference) {
    // Samples spread over whole froxels, found between them again and again, blur edges; they lose no energy, and what
    // moved leaves nothing behind. One frame alone is 3 % off here.
    const TestScene stage = lit_stage();
    const auto error_and_ratio = [&](bool moves) {
        History history;
        std::vector<Scatter> last;
        for (int frame = 0; frame < 12; ++frame)
            last = picture(moved_view(moves ? frame : 11), stage.snapshot, settings(), &history);
        const View view = moved_view(11);
        const auto truth = marched(stage.snapshot, exact_settings(), pixel_rays(view, stage.snapshot, 12));
        return std::pair{relative_rmse(last, truth), mean_of(last) / mean_of(truth)};
    };
    for (const bool moves : {false, true}) {
        const auto [error, ratio] = error_and_ratio(moves);
        EXPECT_LT(error, 0.1) << moves;
        EXPECT_NEAR(ratio, 1, 0.02) << moves;
    }
}

INSTANTIATE_TEST_SUITE_P(Ways, WithHistory,
                         testing::Combine(testing::Bool(),
                                          testing::Values(FroxelVisibility::rays, FroxelVisibility::intervals)));

FroxelHistory history_of(const FroxelGrid& grid, const FroxelTiles& tiles, FroxelLight light) {
    clear_invalid(grid, tiles, light);
    return {grid, std::move(light), {}};
}

TEST(FroxelHistory, AStandingCameraFindsWhatItLeft) {
    const TestScene stage = lit_stage();
    FroxelGrid grid = make_froxel_grid(moved_view(0).camera, {64, 36}, 8);
    const FroxelTiles tiles = make_froxel_tiles(grid, stage.snapshot);
    set_slices(grid, 3, 9, 16, 4, 0, 0);
    FroxelLight light;
    for (size_t i = 0; i < grid.tiles() * 16; ++i)
        for (const float value : {static_cast<float>(i % 7), 2.0f, 3.0f, i % 5 ? 0.1f : 0.0f})
            light.values.push_back(value);
    int remembered = 0;
    const FroxelLight back = reproject(history_of(grid, tiles, light), grid, tiles).light;
    for (size_t tile = 0; tile < grid.tiles(); ++tile)
        for (int k = 0; k < 16; ++k) {
            const float *was = light.at(grid, tile, k), *is = back.at(grid, tile, k);
            const bool known = !is_hidden(grid, tiles, tile, k) && was[3] > 0;
            ASSERT_NEAR(is[3], known ? was[3] : 0, 1e-4) << tile << " " << k;
            if (known) {
                ASSERT_NEAR(is[0], was[0], 1e-2) << tile << " " << k;
                ++remembered;
            }
        }
    EXPECT_GT(remembered, static_cast<int>(grid.tiles()));
}

TEST(FroxelHistory, KnowsHowMuchWiderWhatItFindsBecame) {
    // An orthographic picture moved aside by half a tile: means of two neighbors. By a whole one: the neighbors.
    const TestScene stage = lit_stage();
    Camera camera = moved_view(0).camera;
    camera.ortho_height = 4;
    const auto blur_after = [&](float tiles_aside) {
        FroxelGrid grid = make_froxel_grid(camera, {64, 32}, 8);
        const FroxelTiles tiles = make_froxel_tiles(grid, stage.snapshot);
        set_slices(grid, 3, 9, 16, 1, 0, 0);
        FroxelLight light;
        light.values.assign(4 * grid.tiles() * 16, 1.0f);
        Camera moved = camera;
        moved.position += tiles_aside * (4.0f / 4) * camera.right; // four tiles down
        FroxelGrid now = make_froxel_grid(moved, {64, 32}, 8);
        set_slices(now, 3, 9, 16, 1, 0, 0);
        const FroxelTiles seen = make_froxel_tiles(now, stage.snapshot);
        return reproject(history_of(grid, tiles, light), now, seen).blur[now.tile_index({4, 2})];
    };
    EXPECT_NEAR(blur_after(0), 0, 1e-4);
    EXPECT_NEAR(blur_after(0.5f), 0.25, 1e-4);
    EXPECT_NEAR(blur_after(1), 0, 1e-3);
    EXPECT_NEAR(blur_after(0.1f), 0.09, 1e-3);
}

TEST(FroxelHistory, AQuarterOfTheFroxelsIsNewInEachFrame) {
    const FroxelGrid grid = [] {
        FroxelGrid result = make_froxel_grid(Camera{}, {64, 32}, 8);
        set_slices(result, 1, 9, 16, 4, 0, 0);
        return result;
    }();
    FroxelLight all;
    all.values.assign(4 * grid.tiles() * 16, 1.0f);
    std::vector<int> times(grid.tiles() * 16);
    for (int frame = 0; frame < 4; ++frame) {
        const std::vector<uint8_t> stale = stale_froxels(grid, all, {}, frame);
        for (size_t i = 0; i < stale.size(); ++i) times[i] += !stale[i];
    }
    for (const int count : times) ASSERT_EQ(count, 1);
}
}
}
