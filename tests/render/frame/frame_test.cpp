#include "base/error.h"
#include "modes/mode.h"
#include "render/fixtures.h"
#include "render/frame/frame.h"
#include "scene/camera.h"
#include "scene/light.h"
#include "scene/lights/light_kind.h"
#include "scene/scene.h"
#include "support/expect.h"
#include "support/threads.h"
#include "trace/small_scenes.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/medium.h"

#include <gtest/gtest.h>

#include <glm/gtc/quaternion.hpp>

#include <mutex>

namespace tyndall::test {
namespace {
Layers rendered(const Mode& mode, const View& view, const Snapshot& snapshot, FrameStats& stats,
                bool per_light = false) {
    View asked = view;
    asked.fog_parts = per_light;
    return render_frame(mode, asked, snapshot, Settings{}, FrameOptions{}, stats);
}
Layers rendered(const Mode& mode, const View& view, const Snapshot& snapshot) {
    FrameStats stats;
    return rendered(mode, view, snapshot, stats);
}

}

TEST(Frame, CompositesFogBetweenTransparentSurfaces) {
    const float extinction = 0.3f;
    const vec3 first(4, 2, 1), second(1, 3, 5), behind(0.7f, 0.2f, 0.1f);
    Scene scene;
    add_plane(scene, -2, 50, first, 0.5f);
    add_plane(scene, -5, 50, second, 0.25f);
    Snapshot snapshot = snapshot_of(scene, {homogeneous_medium(extinction, {vec3(-50), vec3(50, 50, 10)})});
    snapshot.media[0].density.bounds.low.z = snapshot.media[0].world_bounds.low.z = -9;
    snapshot.background.color = behind;

    View view = plain_view({8, 8}, 2, 2.0f);
    const Layers layers = rendered(mode_of(prepare_emissive), view, snapshot);
    view.background = false;
    const Layers bare = rendered(mode_of(prepare_emissive), view, snapshot);
    const float t1 = std::exp(-2 * extinction), t2 = std::exp(-3 * extinction), t3 = std::exp(-4 * extinction);
    const vec3 fog1 = fog_radiance * (1 - t1), fog2 = fog_radiance * (1 - t2), fog3 = fog_radiance * (1 - t3);
    const vec3 beyond2 = fog3 + t3 * behind, beyond1 = fog2 + t2 * (0.25f * second + 0.75f * beyond2);
    const float through = t1 * 0.5f * t2 * 0.75f * t3;
    for (int i = 0; i < 64; ++i) {
        expect_near(layers.color.pixels[i], fog1 + t1 * (0.5f * first + 0.5f * beyond1), 1e-5f);
        expect_near(layers.inscatter.pixels[i], fog1 + t1 * 0.5f * (fog2 + t2 * 0.75f * fog3), 1e-5f);
        EXPECT_EQ(layers.alpha.pixels[i], 1) << "the background is in the picture";
        EXPECT_NEAR(bare.alpha.pixels[i], 1 - through, 1e-6f);
        expect_near(bare.color.pixels[i], layers.color.pixels[i] - through * behind, 1e-5f);
        EXPECT_NEAR(layers.transmittance.pixels[i], t1 * t2 * t3, 1e-6f);
        EXPECT_EQ(layers.validity.pixels[i], 1);
        EXPECT_TRUE(std::isinf(layers.depth.pixels[i]));
    }
}

TEST(Frame, OpaqueSurfacesHideWhatIsBehind) {
    Scene scene;
    add_plane(scene, -4, 50, vec3(2));
    add_plane(scene, -6, 50, vec3(9));
    Snapshot snapshot = snapshot_of(scene, {homogeneous_medium(0.1f)});
    snapshot.background.color = vec3(5);
    const Layers layers = rendered(mode_of(prepare_emissive), plain_view({4, 4}, 1, 1.0f), snapshot);
    const float t = std::exp(-0.4f);
    expect_near(layers.color.at(1, 2), fog_radiance * (1 - t) + t * vec3(2), 1e-5f);
    EXPECT_EQ(layers.alpha.at(1, 2), 1);
    EXPECT_FLOAT_EQ(layers.transmittance.at(1, 2), t);
}

TEST(Frame, ABackgroundCoversWhatItIsSeenIn) {
    const Scene scene;
    Snapshot snapshot = snapshot_of(scene);
    snapshot.background.color = vec3(0.25f, 0.5f, 1);
    const Layers layers = rendered(mode_of(prepare_emissive), plain_view({5, 3}, 3), snapshot);
    for (size_t i = 0; i < layers.color.pixels.size(); ++i) {
        expect_near(layers.color.pixels[i], snapshot.background.color, 1e-6f);
        EXPECT_EQ(layers.alpha.pixels[i], 1);
        EXPECT_EQ(layers.transmittance.pixels[i], 1);
    }

    // Left out, or not there, it does not. One that the scene says is black is there.
    View view = plain_view({5, 3}, 3);
    view.background = false;
    EXPECT_EQ(rendered(mode_of(prepare_emissive), view, snapshot).alpha.at(2, 1), 0);
    EXPECT_EQ(rendered(mode_of(prepare_emissive), view, snapshot).color.at(2, 1), vec3(0));
    view.background = true, snapshot.background.color = vec3(0);
    EXPECT_EQ(rendered(mode_of(prepare_emissive), view, snapshot).alpha.at(2, 1), 0);
    snapshot.background.stated = true;
    EXPECT_EQ(rendered(mode_of(prepare_emissive), view, snapshot).alpha.at(2, 1), 1);
}

namespace {
void expect_sums(const Layers& layers) {
    for (size_t i = 0; i < layers.color.pixels.size(); ++i) {
        vec3 fog(0);
        for (const auto& [name, light] : layers.lights) fog += light.pixels[i];
        ASSERT_EQ(layers.inscatter.pixels[i],
                  fog + layers.ambient.pixels[i] + layers.emission.pixels[i] + layers.multiple.pixels[i]);
        ASSERT_EQ(layers.color.pixels[i],
                  layers.surface.pixels[i] + layers.background.pixels[i] + layers.inscatter.pixels[i]);
    }
}
}

TEST(Frame, LayersAddUpBitForBit) {
    Scene scene;
    add_plane(scene, -2, 0.7f, vec3(4, 2, 1), 0.3f);
    Snapshot snapshot = snapshot_of(scene, {homogeneous_medium(0.3f)});
    snapshot.background.color = vec3(0.7f, 0.2f, 0.1f), snapshot.lights.resize(3);
    snapshot.lights[1].name = "b", snapshot.lights[2].name = "c";
    View view = plain_view({33, 21}, 6);
    view.camera.far = 9;
    FrameStats stats;
    const Layers plain = rendered(mode_of(prepare_emissive), view, snapshot, stats);
    Layers one = rendered(mode_of(prepare_emissive), view, snapshot, stats, true);
    view.seed = 1, view.pixel_samples = 4;
    const Layers other = rendered(mode_of(prepare_emissive), view, snapshot, stats, true);
    expect_sums(one);
    EXPECT_GT(max_component(one.surface.at(16, 10)), 0);
    EXPECT_GT(max_component(one.background.at(16, 10)), 0);
    for (size_t i = 0; i < plain.color.pixels.size(); ++i)
        expect_near(one.color.pixels[i], plain.color.pixels[i], 1e-6f);
    blend_layers(one, other, 0.3f);
    expect_sums(one);

    // Each is the same whether the background counts or not.
    view.background = false;
    const Layers bare = rendered(mode_of(prepare_emissive), view, snapshot, stats, true);
    expect_sums(bare);
    EXPECT_TRUE(same_bits(bare.surface, other.surface));
    EXPECT_TRUE(same_bits(bare.inscatter, other.inscatter));
    EXPECT_EQ(bare.background.at(16, 10), vec3(0));
}

TEST(Frame, FogWithoutEndHidesTheBackground) {
    const Scene scene;
    Snapshot snapshot = snapshot_of(scene, {homogeneous_medium(0.02f)});
    snapshot.background.color = vec3(100);
    const Layers layers = rendered(mode_of(prepare_emissive), plain_view({4, 4}, 1), snapshot);
    expect_near(layers.color.at(2, 2), fog_radiance, 1e-6f);
    EXPECT_NEAR(layers.alpha.at(2, 2), 1, 1e-6f);
}

TEST(Frame, DepthIsPlanar) {
    Scene scene;
    add_plane(scene, -7, 100, vec3(0));
    const Snapshot snapshot = snapshot_of(scene);
    View view = plain_view({32, 16}, 4);
    view.camera.vertical_fov = 1.5f;
    const Layers layers = rendered(mode_of(prepare_nothing), view, snapshot);
    for (const float z : layers.depth.pixels) EXPECT_NEAR(z, 7, 2e-5f);
}

TEST(Frame, DepthIsThatOfTheSampleNearestTheCenter) {
    // An opaque square edge cuts pixel (4,4) right of its center: some samples miss, the central one hits.
    Scene scene;
    add_plane(scene, -3, 0.15f, vec3(1));
    const Snapshot snapshot = snapshot_of(scene);
    const View view = plain_view({8, 8}, 64, 2.0f); // a pixel is 0.25 wide; pixel 4 spans 0..0.25
    const Layers layers = rendered(mode_of(prepare_nothing), view, snapshot);
    EXPECT_NEAR(layers.alpha.at(4, 4), 0.36f, 0.05f);
    EXPECT_NEAR(layers.depth.at(4, 4), 3, 1e-5f);
    EXPECT_TRUE(std::isinf(layers.depth.at(5, 4)));
}

TEST(Frame, KeepsBetweenNearAndFar) {
    Scene scene;
    add_plane(scene, -1, 50, vec3(1, 0, 0));
    add_plane(scene, -4, 50, vec3(0, 1, 0));
    add_plane(scene, -9, 50, vec3(0, 0, 1));
    Snapshot snapshot = snapshot_of(scene, {homogeneous_medium(0.1f)});
    View view = plain_view({4, 4}, 1);
    view.camera.near = 2;
    Layers layers = rendered(mode_of(prepare_nothing), view, snapshot);
    expect_near(layers.color.at(0, 3), vec3(0, 1, 0), 0);
    EXPECT_NEAR(layers.depth.at(0, 3), 4, 1e-5f);

    // Beyond the far plane there are no surfaces and no fog, in any direction.
    view.camera.near = 5, view.camera.far = 8;
    layers = rendered(mode_of(prepare_emissive), view, snapshot);
    EXPECT_LT(layers.alpha.at(1, 1), 0.65f);
    EXPECT_TRUE(std::isinf(layers.depth.at(0, 0)));
    const Ray corner = camera_ray(view.camera, view.size, sample_point(view, {0, 0}, 0).position);
    EXPECT_NEAR(layers.transmittance.at(0, 0), std::exp(-0.1f * 8 / -corner.direction.z), 1e-6f);
}

TEST(Frame, CrossesATransparentSurfaceOnceAtAnyAngle) {
    // A floor seen at grazing angles, turned so that no coordinate of a hit is exact.
    const quat turn = glm::angleAxis(0.7f, glm::normalize(vec3(1, 2, 3)));
    Scene scene;
    add_plane(scene, 0, 3000, vec3(1), 0.5f);
    for (vec3& position : scene.meshes[0].positions) position = turn * vec3(position.x, 0, -position.y);
    const Snapshot snapshot = snapshot_of(scene);
    View view = plain_view({128, 128}, 2);
    view.camera = look_at(turn * vec3(101.3f, 0.02f, -37.7f), turn * vec3(100, 0.02f, -40), turn * vec3(0, 1, 0), 0.2f);
    const Layers layers = rendered(mode_of(prepare_nothing), view, snapshot);
    int floor = 0;
    for (const vec3& color : layers.color.pixels) {
        // Both samples hit the floor, one does, or none.
        ASSERT_TRUE(color.x == 0.5f || color.x == 0.25f || color.x == 0) << color.x;
        floor += color.x == 0.5f;
    }
    EXPECT_NEAR(floor, 64 * 128, 2 * 128);
}

TEST(Frame, TakesTheSixtyFourthLayerAsOpaque) {
    Scene scene;
    for (int i = 0; i < 70; ++i) add_plane(scene, -1 - 0.1f * i, 50, vec3(1), 0.125f);
    Snapshot snapshot = snapshot_of(scene);
    snapshot.background.color = vec3(1000);
    const Layers layers = rendered(mode_of(prepare_nothing), plain_view({4, 4}, 1), snapshot);
    EXPECT_NEAR(layers.color.at(0, 0).x, 1, 1e-5f); // all layers glow with 1
    EXPECT_EQ(layers.alpha.at(0, 0), 1);
    EXPECT_NEAR(layers.depth.at(0, 0), 7.3f, 1e-4f);
}

TEST(Frame, HasTheSameBitsForAnyThreadCountAndCrop) {
    Scene scene;
    add_plane(scene, -2, 0.6f, vec3(1), 0.5f);
    add_plane(scene, -3, 1.0f, vec3(2, 1, 0));
    const Snapshot snapshot = snapshot_of(scene, {homogeneous_medium(0.2f)});
    View view = plain_view({75, 46}, 3); // tiles are cut at the right and lower edge
    view.filter = PixelFilter::blackman_harris, view.filter_radius = 1.5f, view.seed = 11, view.frame = 7;
    const Mode mode = mode_of(prepare_everything);

    FrameStats stats_1, stats_2, stats_crop;
    const Layers one = on_threads(1, [&] { return rendered(mode, view, snapshot, stats_1); });
    const Layers two = on_threads(2, [&] { return rendered(mode, view, snapshot, stats_2); });
    EXPECT_TRUE(same_bits(one.color, two.color));
    EXPECT_TRUE(same_bits(one.inscatter, two.inscatter));
    EXPECT_TRUE(same_bits(one.alpha, two.alpha));
    EXPECT_TRUE(same_bits(one.depth, two.depth));
    EXPECT_TRUE(same_bits(one.validity, two.validity));
    EXPECT_EQ(stats_1.steps, stats_2.steps);
    EXPECT_EQ(stats_1.camera_rays, 75u * 46 * 3);

    view.crop_low = {33, 5}, view.crop_high = {70, 45};
    const Layers crop = rendered(mode, view, snapshot, stats_crop);
    EXPECT_EQ(crop.display, view.size);
    EXPECT_EQ(crop.low, view.crop_low);
    EXPECT_EQ(stats_crop.camera_rays, 37u * 40 * 3);
    EXPECT_TRUE(same_bits(crop.color, cut(one.color, view.crop_low, view.crop_high)));
    EXPECT_TRUE(same_bits(crop.transmittance, cut(one.transmittance, view.crop_low, view.crop_high)));
    EXPECT_TRUE(same_bits(crop.depth, cut(one.depth, view.crop_low, view.crop_high)));
}

TEST(Frame, SeedAndFrameChangeTheNoise) {
    const Scene scene;
    const Snapshot snapshot = snapshot_of(scene);
    View view = plain_view({16, 16}, 1);
    const Mode mode = mode_of(prepare_everything);
    const Layers first = rendered(mode, view, snapshot);
    view.seed = 1;
    EXPECT_FALSE(same_bits(first.color, rendered(mode, view, snapshot).color));
    view.seed = 0, view.frame = 1;
    EXPECT_FALSE(same_bits(first.color, rendered(mode, view, snapshot).color));
}

namespace {
std::mutex seen_mutex;
std::vector<float> seen_jitter;
std::vector<uint32_t> seen_ids;

ScatterFunction prepare_record(const View&, const Snapshot&, const Settings&, History*) {
    return [](const RayBatch& batch, std::span<Scatter> results) {
        const std::lock_guard lock(seen_mutex);
        seen_jitter.insert(seen_jitter.end(), batch.jitter.begin(), batch.jitter.end());
        seen_ids.insert(seen_ids.end(), batch.ids.begin(), batch.ids.end());
        std::ranges::fill(results, Scatter{});
    };
}
}

TEST(Frame, StratifiesTheJitterOfAPixel) {
    const Scene scene;
    const Snapshot snapshot = snapshot_of(scene);
    seen_jitter.clear(), seen_ids.clear();
    rendered(mode_of(prepare_record), plain_view({1, 1}, 16), snapshot);
    ASSERT_EQ(seen_jitter.size(), 16u);
    std::vector<int> strata(16);
    for (const float jitter : seen_jitter) ++strata.at(static_cast<size_t>(jitter * 16));
    EXPECT_EQ(std::ranges::count(strata, 1), 16);
}

TEST(Frame, GivesEverySampleAnIdOfItsOwn) {
    Scene scene;
    add_plane(scene, -2, 50, vec3(1), 0.5f);
    const Snapshot snapshot = snapshot_of(scene);
    seen_jitter.clear(), seen_ids.clear();
    rendered(mode_of(prepare_record), plain_view({32, 32}, 4), snapshot);
    ASSERT_EQ(seen_ids.size(), 2u * 32 * 32 * 4);
    std::ranges::sort(seen_ids);
    // 8192 random 32 bit numbers collide 0.008 times on average.
    EXPECT_LE(std::ranges::size(std::ranges::unique(seen_ids)), 1u);
}

namespace {
// Not finite on the left edge of the picture.
ScatterFunction prepare_broken(const View&, const Snapshot&, const Settings&, History*) {
    return [](const RayBatch& batch, std::span<Scatter> results) {
        for (size_t i = 0; i < results.size(); ++i) {
            const vec3 o = batch.rays[i].origin;
            const bool left = o.x < -0.75f;
            results[i] = {vec3(left ? o.y > 0 ? infinity : NAN : 1.0f), 1, 1, 1};
        }
    };
}
}

TEST(Frame, CountsAndDropsSamplesThatAreNotFinite) {
    const Scene scene;
    const Snapshot snapshot = snapshot_of(scene);
    FrameStats stats;
    View view = plain_view({80, 80}, 4, 2.0f);
    const Layers layers = rendered(mode_of(prepare_broken), view, snapshot, stats);
    EXPECT_EQ(stats.non_finite, 10u * 80 * 4);
    EXPECT_EQ(stats.first_non_finite, ivec2(0, 0));
    expect_near(layers.color.at(9, 40), vec3(0), 0);
    EXPECT_EQ(layers.validity.at(9, 40), 0);
    expect_near(layers.color.at(10, 40), vec3(1), 0);
    EXPECT_EQ(layers.validity.at(10, 40), 1);

    view.crop_low = {5, 50}, view.crop_high = {80, 80};
    rendered(mode_of(prepare_broken), view, snapshot, stats);
    EXPECT_EQ(stats.non_finite, 5u * 30 * 4);
    EXPECT_EQ(stats.first_non_finite, ivec2(5, 50));
}

TEST(Frame, SplitsTheLightByName) {
    Scene scene;
    for (const char* name : {"key", "dark", "key", "rim"}) {
        LightSource source;
        source.name = name;
        scene.lights.push_back(source);
    }
    add_plane(scene, -3, 50, vec3(0));
    scene.materials[0].base_color = vec3(0.8f);
    Snapshot snapshot = snapshot_of(scene, {homogeneous_medium(0.2f, Box{vec3(-50, -50, -3), vec3(50, 50, 1)})});
    for (const char* name : {"key", "key", "rim"}) {
        Light light;
        light.name = name, light.kind = LightKind::sun, light.direction = vec3(0, 0, -1);
        light.intensity = vec3(name[0] == 'k' ? 2 : 6);
        snapshot.lights.push_back(light);
    }
    FrameStats stats;
    const Layers layers = rendered(mode_of(prepare_emissive), plain_view({9, 9}, 2), snapshot, stats, true);
    ASSERT_EQ(layers.lights.size(), 3u);
    EXPECT_EQ(layers.lights[0].first, "key");
    EXPECT_EQ(layers.lights[1].first, "dark");
    EXPECT_EQ(layers.lights[2].first, "rim");
    for (size_t i = 0; i < layers.color.pixels.size(); ++i) {
        const vec3 key = layers.lights[0].second.pixels[i], rim = layers.lights[2].second.pixels[i];
        expect_near(key + rim, layers.inscatter.pixels[i], 1e-5f);
        expect_near(layers.lights[1].second.pixels[i], vec3(0), 0);
        // The fog is said to come from three lights alike, of which two have a name; surfaces are apart.
        expect_near(key, layers.inscatter.pixels[i] * (2.0f / 3), 1e-5f);
        EXPECT_GT(layers.surface.pixels[i].x, 0);
    }
}

TEST(Frame, StopsWhenCancelled) {
    const Scene scene;
    const Snapshot snapshot = snapshot_of(scene);
    std::atomic<bool> cancel = true;
    FrameOptions options;
    options.cancel = &cancel;
    FrameStats stats;
    EXPECT_THROW(render_frame(mode_of(prepare_nothing), plain_view({64, 64}, 1), snapshot, Settings{}, options, stats),
                 Error);
}

TEST(Frame, ReportsProgressToTheEnd) {
    const Scene scene;
    const Snapshot snapshot = snapshot_of(scene);
    std::mutex mutex;
    std::vector<double> said;
    FrameOptions options;
    options.progress = [&](double share) {
        const std::lock_guard lock(mutex);
        said.push_back(share);
    };
    FrameStats stats;
    render_frame(mode_of(prepare_nothing), plain_view({100, 40}, 1), snapshot, Settings{}, options, stats);
    EXPECT_EQ(said.size(), 8u);
    EXPECT_EQ(std::ranges::max(said), 1);
}
}
