// Froxels and where they lie.
#include "modes/froxel/grid.h"
#include "scene/scene.h"
#include "trace/occlusion/occluders.h"

#include "modes/froxel/froxel_fixtures.h"
#include "modes/froxel/settings.h"
#include "modes/froxel/tiles.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
Camera slanted_camera(bool ortho) {
    Camera camera = look_at({1, 2, 3}, {-2, 0.5f, -4}, {0.1f, 1, 0}, 0.9f);
    if (ortho) camera.ortho_height = 5;
    return camera;
}

TEST(FroxelGrid, SmallImagesHaveSmallFroxels) {
    for (const auto& [lines, tile] : {std::pair{1080, 8}, {360, 8}, {270, 4}, {180, 2}, {108, 1}, {18, 1}})
        EXPECT_EQ(with_tile({}, {lines * 16 / 9, lines}).tile, tile) << lines;
    FroxelSettings chosen;
    chosen.tile = 16;
    EXPECT_EQ(with_tile(chosen, {640, 360}).tile, 16);
    EXPECT_EQ(with_tile(chosen, {320, 180}).tile, 4);
}

TEST(FroxelGrid, PointsOfThePictureComeBack) {
    for (const bool ortho : {false, true})
        for (const int tile : {1, 8, 30}) {
            const FroxelGrid grid = make_froxel_grid(slanted_camera(ortho), {200, 120}, tile);
            for (const vec2 pixel : {vec2(0.5f, 0.5f), vec2(100, 60), vec2(199, 3), vec2(-4, 125)})
                for (const float z : {0.3f, 2.0f, 50.0f}) {
                    const vec3 back = project(grid, grid.point(pixel, z));
                    EXPECT_NEAR(back.x, pixel.x, 2e-3);
                    EXPECT_NEAR(back.y, pixel.y, 2e-3);
                    EXPECT_NEAR(back.z / z, 1, 1e-5);
                    const vec2 place = grid.pixel_of(grid.tile_of(pixel));
                    EXPECT_NEAR(place.x, pixel.x, 1e-4);
                    EXPECT_NEAR(place.y, pixel.y, 1e-4);
                }
        }
}

TEST(FroxelGrid, LinesAreTheCamerasRays) {
    for (const bool ortho : {false, true}) {
        const Camera camera = slanted_camera(ortho);
        const FroxelGrid grid = make_froxel_grid(camera, {200, 120}, 8);
        const Ray ray = camera_ray(camera, {200, 120}, {31, 77});
        const vec3 step = glm::normalize(grid.line_step({31, 77}));
        EXPECT_LT(glm::length(step - ray.direction), 1e-6f);
        EXPECT_LT(glm::length(glm::cross(grid.point({31, 77}, 7) - ray.origin, ray.direction)), 1e-5f);
    }
}

TEST(FroxelGrid, APictureHasATileBeyondEachEdge) {
    const FroxelGrid grid = make_froxel_grid(Camera{}, {640, 360}, 8);
    EXPECT_EQ(grid.size, ivec2(82, 47));
    EXPECT_EQ(grid.tile_of_pixel({0.5f, 0.5f}), ivec2(1, 1));
    EXPECT_EQ(grid.tile_of_pixel({639.5f, 359.5f}), ivec2(80, 45));
}

TEST(FroxelGrid, SlicesGrowAsAskedAndAreFoundAgain) {
    FroxelGrid grid = make_froxel_grid(Camera{}, {64, 36}, 8);
    for (const float growth : {1.0f, 4.0f, 200.0f})
        for (const int count : {1, 2, 64, 1000})
            for (const float end : {0.0f, 5000.0f}) {
                set_slices(grid, 0.5f, 40, count, growth, end, 12);
                ASSERT_EQ(grid.slices(), end > 0 ? count + 12 : count);
                EXPECT_FLOAT_EQ(grid.faces[0], 0.5f);
                EXPECT_FLOAT_EQ(grid.faces[count], 40);
                EXPECT_FLOAT_EQ(grid.faces.back(), std::max(end, 40.0f));
                const double first = grid.faces[1] - grid.faces[0], last = grid.faces[count] - grid.faces[count - 1];
                // Thicknesses are differences of floats near 40.
                if (count > 1) {
                    EXPECT_NEAR(last / first / growth, 1, 4e-2) << count;
                }
                for (int k = 0; k < grid.slices(); ++k) {
                    const float middle = 0.5f * (grid.faces[k] + grid.faces[k + 1]);
                    ASSERT_EQ(slice_of(grid, middle), k);
                    ASSERT_EQ(slice_of(grid, grid.faces[k]), k);
                }
                EXPECT_EQ(slice_of(grid, -1), 0);
                EXPECT_EQ(slice_of(grid, infinity), grid.slices() - 1);
            }
}

TEST(FroxelTiles, DepthsReachFromTheFirstFogToTheLastSurface) {
    // Fog from z = -2 to -30, a wall across the right half of the view at z = -10 (camera at 0, looking down -z).
    const TestScene stage = make_scene({homogeneous_medium(0.1f, {{-100, -100, -30}, {100, 100, -2}})}, {},
                                       {quad({0, -50, -10}, {50, 0, 0}, {0, 100, 0})});
    const View view = view_of(vec3(0), {0, 0, -1});
    const FroxelGrid grid = make_froxel_grid(view.camera, view.size, 8);
    const FroxelTiles tiles = make_froxel_tiles(grid, stage.snapshot);
    const size_t right = grid.tile_index({7, 3}), left = grid.tile_index({2, 3});
    EXPECT_NEAR(tiles.nearest[right], 10, 1e-4);
    EXPECT_NEAR(tiles.farthest[right], 10, 1e-4);
    EXPECT_TRUE(std::isinf(tiles.nearest[left]));
    const FogDepths depths = fog_depths(grid, tiles, stage.snapshot);
    EXPECT_NEAR(depths.near, 2, 1e-4);
    EXPECT_NEAR(depths.far, 30, 1e-3);
    EXPECT_EQ(depths.end, 0);
}

TEST(FroxelTiles, GlassHidesNothing) {
    const TestScene stage =
        make_scene({homogeneous_medium(0.1f)}, {}, {quad({-50, -50, -10}, {100, 0, 0}, {0, 100, 0})});
    Scene scene = *stage.scene;
    scene.meshes[0].material = 0;
    Snapshot snapshot = stage.snapshot;
    snapshot.occluders = Occluders::make(scene, 0, nullptr);
    const View view = view_of(vec3(0), {0, 0, -1});
    const FroxelGrid grid = make_froxel_grid(view.camera, view.size, 8);
    const auto depths = [&](const Snapshot& seen) { return make_froxel_tiles(grid, seen).depth; };
    EXPECT_GE(depths(snapshot).size(), grid.tiles());
    EXPECT_THAT(depths(snapshot), testing::Each(infinity));
    EXPECT_THAT(depths(stage.snapshot), testing::Each(testing::FloatNear(10, 1e-3f)));
}
}
}
