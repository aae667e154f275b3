// What mattes hold out, against closed forms, in shared surfaces and in those of a mode.
#include "modes/mode.h"
#include "modes/settings.h"
#include "render/fixtures.h"
#include "render/frame/frame.h"
#include "scene/scene.h"
#include "support/expect.h"
#include "trace/small_scenes.h"
#include "trace/snapshot.h"
#include "trace/view.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
constexpr float extinction = 0.3f;
const vec3 behind(0.7f, 0.2f, 0.1f);

struct Held {
    Scene scene;
    Snapshot snapshot;
};

// A plane at depth 2 that may be BLEND, one at 5, in fog up to depth 9, before a background.
void hold(Held& held, bool first, bool second, float alpha) {
    add_plane(held.scene, -2, 50, vec3(4, 2, 1), alpha);
    add_plane(held.scene, -5, 50, vec3(1, 3, 5));
    held.scene.instances[0].matte = first, held.scene.instances[1].matte = second;
    held.snapshot = snapshot_of(held.scene, {homogeneous_medium(extinction, {vec3(-50, -50, -9), vec3(50)})});
    held.snapshot.background.color = behind;
}

Layers rendered(const Snapshot& snapshot, bool background = true, bool parts = false) {
    View view = plain_view({8, 8}, 2, 2.0f);
    view.background = background, view.fog_parts = parts;
    FrameStats stats;
    return render_frame(mode_of(prepare_emissive), view, snapshot, Settings{}, FrameOptions{}, stats);
}

const float t1 = std::exp(-2 * extinction), t2 = std::exp(-3 * extinction);

TEST(Mattes, HoldOutAllBehindThem) {
    Held held;
    hold(held, true, false, 1);
    for (const bool background : {true, false}) {
        const Layers layers = rendered(held.snapshot, background);
        for (int i = 0; i < 64; ++i) {
            expect_near(layers.color.pixels[i], fog_radiance * (1 - t1), 1e-5f);
            EXPECT_NEAR(layers.alpha.pixels[i], 1 - t1, 1e-6f);
            EXPECT_NEAR(layers.depth.pixels[i], 2, 1e-5f);
            EXPECT_NEAR(layers.transmittance.pixels[i], t1, 1e-6f);
        }
    }
}

TEST(Mattes, BehindASurfaceTheyAreHeldByIt) {
    Held held;
    hold(held, false, true, 0.25f);
    held.snapshot.lights.resize(1); // the fog is its light
    const Layers layers = rendered(held.snapshot, true, true);
    const float through = t1 * 0.75f;
    const vec3 expected = fog_radiance * (1 - t1) + t1 * 0.25f * vec3(4, 2, 1) + through * fog_radiance * (1 - t2);
    for (int i = 0; i < 64; ++i) {
        expect_near(layers.color.pixels[i], expected, 1e-5f);
        EXPECT_NEAR(layers.alpha.pixels[i], 1 - through * t2, 1e-6f);
        EXPECT_EQ(layers.color.pixels[i],
                  layers.surface.pixels[i] + layers.background.pixels[i] + layers.inscatter.pixels[i]);
        EXPECT_EQ(layers.background.pixels[i], vec3(0));
    }
}

TEST(Mattes, OfGlassHoldOutTheirShare) {
    Held held;
    hold(held, true, false, 0.25f);
    const Layers layers = rendered(held.snapshot);
    const vec3 expected = fog_radiance * (1 - t1) + t1 * 0.75f * (fog_radiance * (1 - t2) + t2 * vec3(1, 3, 5));
    for (int i = 0; i < 64; ++i) {
        expect_near(layers.color.pixels[i], expected, 1e-5f);
        EXPECT_NEAR(layers.alpha.pixels[i], 1 - 0.25f * t1, 1e-6f);
    }
}

// Beside the matte the background covers what it is seen in, or is left out.
TEST(Mattes, ABackgroundCoversTheRest) {
    Scene scene;
    add_plane(scene, -2, 0.5f, vec3(1));
    scene.instances[0].matte = true;
    Snapshot snapshot = snapshot_of(scene, {homogeneous_medium(extinction, {vec3(-50, -50, -9), vec3(50)})});
    snapshot.background.color = behind;
    const Layers layers = rendered(snapshot), bare = rendered(snapshot, false);
    EXPECT_NEAR(layers.alpha.at(4, 4), 1 - t1, 1e-6f);
    EXPECT_EQ(layers.alpha.at(0, 0), 1);
    EXPECT_NEAR(bare.alpha.at(4, 4), 1 - t1, 1e-6f);
    EXPECT_NEAR(bare.alpha.at(0, 0), 1 - std::exp(-9 * extinction), 1e-6f);
    expect_near(layers.color.at(4, 4), bare.color.at(4, 4), 0.0f);
}

// With light that scatters once, path and march hold out alike, and the matte shadows the fog before it.
TEST(Mattes, PathHoldsOutAsMarchDoes) {
    Scene scene;
    Mesh wall = quad({-0.6f, -0.6f, -4}, {1.2f, 0, 0}, {0, 1.2f, 0});
    scene.meshes = {wall, box_of({-0.3f, 0.2f, -3.2f}, {0.3f, 0.5f, -2.8f})};
    scene.instances = {{-1, 0, true, true}, {-1, 1, true, true}};
    Snapshot snapshot =
        snapshot_of(scene, {homogeneous_medium(extinction, {vec3(-2, -2, -7), vec3(2, 2, -1)}, {}, vec3(0.9f))});
    snapshot.lights = {point_light({0, 1.5f, -3}, 20)};
    Settings settings = settings_for(Quality::preview);
    settings.path.orders = settings.fluence.orders = 1;
    View view = plain_view({24, 16}, 64);
    view.batches = 8;
    FrameStats stats;
    const Layers march = render_frame(find_mode("march"), view, snapshot, settings, FrameOptions{}, stats);
    view.pixel_samples = 512;
    const Layers path = render_frame(find_mode("path"), view, snapshot, settings, FrameOptions{}, stats);
    double sum = 0, off = 0, variance = 0;
    for (size_t i = 0; i < march.color.pixels.size(); ++i) {
        ASSERT_NEAR(path.alpha.pixels[i], march.alpha.pixels[i], 0.05f) << i;
        sum += double(march.color.pixels[i].y), off += double(path.color.pixels[i].y - march.color.pixels[i].y);
        variance += double(path.variance.pixels[i].y + march.variance.pixels[i].y);
    }
    EXPECT_GT(sum, 0);
    EXPECT_LT(std::abs(off), 4 * std::sqrt(variance));
    EXPECT_LT(march.alpha.at(12, 8), 1 - std::exp(-3.01f * extinction) + 1e-3f);
}
}
}
