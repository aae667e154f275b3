// Fluence beside surfaces and at the rim of the fog.
#include "base/random.h"
#include "modes/settings.h"
#include "scene/scene.h"
#include "support/tiny_scenes.h"
#include "trace/fluence/fluence.h"
#include "trace/fluence/settings.h"
#include "trace/snapshot.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
constexpr FluenceSettings twice{2, 16, 1'000'000};

// Mean of what is known in a box.
double mean_fluence(const FluenceGrid& grid, const Box& box) {
    double sum = 0;
    constexpr int count = 4096;
    for (uint32_t i = 0; i < count; ++i) {
        const Sample2 across = sample2(i, 3);
        const vec3 place(across.x, (static_cast<float>(i) + 0.5f) / count, across.y);
        sum += fluence_at(grid, box.low + box.size() * place).fluence.x / count;
    }
    return sum;
}

Snapshot with_surfaces(Scene& scene, const Box& fog, vec3 sun_direction, float extinction = 0.5f) {
    Snapshot snapshot = snapshot_of({homogeneous_medium(extinction, fog)}, {sun_light(sun_direction)});
    add_surfaces(scene, snapshot);
    return snapshot;
}

// A layer of fog is as bright wherever the grid's cells lie, up to what is missing beside it: cells at its rim know the
// mean of light within and without.
TEST(FluenceRim, ALayerBetweenTheCellsIsAsBrightAsOneOnThem) {
    const float cell = 2.0f / twice.resolution;
    const auto brightness = [&](float low) {
        const Box layer{vec3(-1, low, -1), vec3(1, low + 2 * cell, 1)};
        const Snapshot snapshot = snapshot_of({homogeneous_medium(1, layer)}, {sun_light({0.2f, -1, 0})});
        return mean_fluence(make_fluence(snapshot, twice), layer);
    };
    const double on_cells = brightness(2 * cell);
    for (const float shift : {0.25f, 0.5f, 0.8f})
        EXPECT_NEAR(brightness((2 + shift) * cell), on_cells, 0.12 * on_cells) << shift;
}

// What lies below a floor is dark and takes nothing from the fog above. Of the cells that the floor cuts little is
// known where fog ends close below it: with eight times the paths they are 6 % off, with these noise adds 4 %. Cells
// further up take a part of them, by the widest filter (8 - distance) / 64.
TEST(FluenceWalls, FogThatGoesOnBelowAFloorIsAsBrightAboveIt) {
    struct Place {
        float height;
        double tolerance;
    };
    constexpr std::array<Place, 4> places{
        {{0.01f, 0.06 + 3 * 0.04}, {0.08f, 0.1}, {0.2f, 0.18 * 7 / 64}, {0.5f, 0.18 * 4 / 64}}};
    const auto fluences = [&](float low) {
        Scene scene;
        scene.materials = {lambert(vec3(0))};
        add_mesh(scene, floor_of(0, 6, 0));
        const Snapshot snapshot = with_surfaces(scene, {vec3(-1, low, -1), vec3(1)}, {0, -1, 0});
        const FluenceGrid grid = make_fluence(snapshot, twice);
        std::array<double, places.size()> result;
        for (size_t i = 0; i < places.size(); ++i)
            result[i] =
                mean_fluence(grid, {vec3(-0.5f, places[i].height, -0.5f), vec3(0.5f, places[i].height + 0.02f, 0.5f)});
        return result;
    };
    const auto cut_off = fluences(0);
    for (const float low : {-0.25f, -0.33f, -0.41f, -1.0f}) {
        const auto whole = fluences(low);
        for (size_t i = 0; i < places.size(); ++i)
            EXPECT_NEAR(whole[i] / cut_off[i], 1, places[i].tolerance)
                << places[i].height << " above, fog from " << low;
    }
}

TEST(FluenceWalls, AClosedRoomIsDarkInside) {
    Scene scene;
    scene.materials = {lambert(vec3(0.8f))};
    add_mesh(scene, box_of(vec3(-0.53f), vec3(0.53f), 0));
    const Snapshot snapshot = with_surfaces(scene, {vec3(-1), vec3(1)}, {0.3f, -1, 0.2f}, 2);
    const FluenceGrid grid = make_fluence(snapshot, {all_orders, 16, 200'000});
    EXPECT_GT(mean_fluence(grid, {vec3(-0.95f), vec3(-0.6f)}), 0.1);
    EXPECT_EQ(mean_fluence(grid, {vec3(-0.49f), vec3(0.49f)}), 0) << "0.04 m from the walls, cells of 0.125 m";
}

// A black screen in thin fog, lit along both sides, keeps from each side what the other scatters: half of it. A quarter
// of a cut cell may count for the wrong side.
TEST(FluenceWalls, AScreenLitOnBothSidesIsHalfAsBrightAsNone) {
    const auto fluence = [](bool screen) {
        Scene scene;
        scene.materials = {lambert(vec3(0))};
        add_mesh(scene, screen ? box_of(vec3(0.03f, -3, -3), vec3(0.031f, 3, 3), 0) : floor_of(-9, 1, 0));
        const Snapshot snapshot = with_surfaces(scene, {vec3(-1), vec3(1)}, {0, -1, 0}, 0.1f);
        const FluenceGrid grid = make_fluence(snapshot, twice);
        return mean_fluence(grid, {vec3(0.035f, -0.5f, -0.5f), vec3(0.08f, 0.5f, 0.5f)}) +
               mean_fluence(grid, {vec3(-0.03f, -0.5f, -0.5f), vec3(0.025f, 0.5f, 0.5f)});
    };
    const double share = fluence(true) / fluence(false);
    EXPECT_GT(share, 0.4);
    EXPECT_LT(share, 0.67);
}
}
}
