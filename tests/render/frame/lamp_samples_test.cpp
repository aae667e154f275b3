// More rays around lamps, whose glow in the fog changes within a pixel.
#include "integrate/ray_batch.h"
#include "modes/mode.h"
#include "modes/settings.h"
#include "render/fixtures.h"
#include "render/frame/frame.h"
#include "render/frame/layers.h"
#include "scene/light.h"
#include "scene/lights/light_kind.h"
#include "scene/scene.h"
#include "trace/small_scenes.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/medium.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
constexpr ivec2 size(64, 32);

// Light that falls with the distance from the middle of the picture, in pixels, as fog around a lamp does.
ScatterFunction prepare_lamp_glow(const View& view, const Snapshot&, const Settings&, History*) {
    return [middle = 0.5f * vec2(view.size)](const RayBatch& batch, std::span<Scatter> results) {
        for (size_t i = 0; i < results.size(); ++i)
            results[i] = {vec3(1 / glm::distance(batch.positions[i], middle)), 1, 1, 1, {}};
    };
}

// A lamp straight ahead: in the middle of the picture, where four pixels meet.
Snapshot lamp_scene(const Scene& scene, LightKind kind = LightKind::point) {
    Snapshot snapshot = snapshot_of(scene, {homogeneous_medium(0.1f)});
    snapshot.lights.emplace_back();
    snapshot.lights[0].kind = kind, snapshot.lights[0].position = {0, 0, -5};
    return snapshot;
}

Layers rendered(const Snapshot& snapshot, int lamp_samples, FrameStats& stats, int samples = 1) {
    View view = plain_view(size, samples);
    view.lamp_samples = lamp_samples;
    return render_frame(mode_of(prepare_lamp_glow), view, snapshot, Settings{}, {}, stats);
}

TEST(LampSamples, PixelsAtALampTakeTheirMean) {
    // ∫ 1/r over a unit square with the lamp at a corner is 2 ln(1 + √2).
    const Scene scene;
    const Snapshot snapshot = lamp_scene(scene);
    const float mean = 2 * std::log(1 + std::sqrt(2.0f));
    FrameStats one, many;
    const float center = rendered(snapshot, 1, one).inscatter.at(32, 16).x;
    const Layers layers = rendered(snapshot, 64, many);
    EXPECT_NEAR(center, std::sqrt(2.0f), 1e-5f);
    // Of 1024 samples a pixel: what lies in the corner cell of 1/32, where one sample stands for 2 ln(1 + √2) / 32, is
    // off by about as much in each of four pixels. In the middle it is .35 off.
    const Layers fine = rendered(snapshot, 64, many, 16);
    float around = 0;
    for (const ivec2 p : {ivec2(31, 15), ivec2(32, 15), ivec2(31, 16), ivec2(32, 16)})
        around += fine.inscatter.at(p.x, p.y).x / 4;
    EXPECT_NEAR(around, mean, 3 * mean / 32 / 2);
    EXPECT_NE(layers.inscatter.at(32, 16), fine.inscatter.at(32, 16));
    EXPECT_EQ(layers.transmittance.at(32, 16), 1);
    rendered(snapshot, 64, many);
    EXPECT_EQ(one.camera_rays, static_cast<uint64_t>(size.x * size.y));
    EXPECT_GT(many.camera_rays, one.camera_rays);
    EXPECT_LT(many.camera_rays, one.camera_rays + 64 * 24 * 24); // at most the pixels within eight

    // Far away one sample in the middle is all there is.
    EXPECT_EQ(layers.inscatter.at(60, 16).x, 1 / glm::distance(vec2(60.5f, 16.5f), vec2(32, 16)));
}

TEST(LampSamples, AMeanOfManySamplesIsTheSame) {
    const Scene scene;
    const Snapshot snapshot = lamp_scene(scene);
    FrameStats stats;
    const Layers plain = rendered(snapshot, 1, stats, 1024), dense = rendered(snapshot, 16, stats, 64);
    for (int x = 24; x < 40; ++x) EXPECT_NEAR(dense.inscatter.at(x, 16).x / plain.inscatter.at(x, 16).x, 1, 0.02f) << x;
}

TEST(LampSamples, OnlyWhereTheyMakeADifference) {
    const Scene scene;
    const uint64_t once = static_cast<uint64_t>(size.x * size.y);
    FrameStats stats;
    rendered(lamp_scene(scene, LightKind::sun), 64, stats);
    EXPECT_EQ(stats.camera_rays, once);

    Snapshot behind = lamp_scene(scene), clear = lamp_scene(scene), large = lamp_scene(scene);
    behind.lights[0].position.z = 5;
    rendered(behind, 64, stats);
    EXPECT_EQ(stats.camera_rays, once);
    clear.media.clear();
    rendered(clear, 64, stats);
    EXPECT_EQ(stats.camera_rays, once);
    large.lights[0].radius = 4; // far more than eight pixels: its glow is smooth
    rendered(large, 64, stats);
    EXPECT_EQ(stats.camera_rays, once);

    View centered = plain_view(size, 1);
    centered.lamp_samples = 64, centered.filter = PixelFilter::center;
    render_frame(mode_of(prepare_lamp_glow), centered, lamp_scene(scene), Settings{}, {}, stats);
    EXPECT_EQ(stats.camera_rays, once);
}

TEST(LampSamples, DoNotDependOnTheCrop) {
    const Scene scene;
    const Snapshot snapshot = lamp_scene(scene);
    FrameStats stats;
    const Layers whole = rendered(snapshot, 64, stats, 2);
    View view = plain_view(size, 2);
    view.lamp_samples = 64, view.crop_low = {30, 13}, view.crop_high = {37, 19};
    const Layers part = render_frame(mode_of(prepare_lamp_glow), view, snapshot, Settings{}, {}, stats);
    for (int y = 13; y < 19; ++y)
        for (int x = 30; x < 37; ++x) EXPECT_EQ(part.inscatter.at(x - 30, y - 13), whole.inscatter.at(x, y));
}
}
}
