#include "modes/mode.h"
#include "render/frame/noise_fixtures.h"
#include "scene/light.h"
#include "scene/lights/light_kind.h"
#include "scene/scene.h"
#include "support/threads.h"
#include "trace/occlusion/occluders.h"
#include "trace/small_scenes.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/medium.h"
#include "volume/rays/fog_reach.h"

#include <gtest/gtest.h>

#include <mutex>

namespace tyndall::test {
namespace {
// What the renderer does for prepare_emissive and surfaces that only glow, done by the mode: ray by ray.
Scatter followed(const Snapshot& snapshot, Ray ray, float near) {
    const float extinction = gray_extinction(snapshot.media[0].optics);
    Scatter result;
    float through = 1;
    for (int layer = 0; layer < 64; ++layer) {
        Hits hits;
        const Ray tested{ray.at(near), ray.direction, ray.t_max - near};
        hits.instance.fill(-1);
        snapshot.occluders->closest({&tested, 1}, 0, hits);
        const bool hit = hits.instance[0] >= 0;
        const float t = hit ? near + hits.t[0] : fog_reach(snapshot.media, ray);
        const float transmittance = std::exp(-extinction * t);
        result.radiance += through * (1 - transmittance) * fog_radiance;
        result.transmittance *= transmittance;
        through *= transmittance;
        if (!hit) {
            result.background += through * snapshot.background.color;
            break;
        }
        const SurfacePoint point = snapshot.occluders->surface(tested, hits, 0);
        result.surface += through * point.alpha * point.emission;
        if (point.alpha >= 1) break;
        through *= 1 - point.alpha;
        ray = {ray.at(t), ray.direction, ray.t_max - t};
        near = 1e-3f;
    }
    return result;
}

ScatterFunction prepare_follow(const View&, const Snapshot& snapshot, const Settings&, History*) {
    return [&snapshot](const RayBatch& batch, std::span<Scatter> results) {
        const size_t lights = batch.parts.empty() ? 0 : snapshot.lights.size();
        for (size_t i = 0; i < results.size(); ++i) {
            results[i] = followed(snapshot, batch.rays[i], batch.clip_near[i]);
            for (size_t l = 0; l < lights; ++l) batch.part(i, l) = static_cast<float>(l + 1) / 3 * results[i].radiance;
        }
    };
}

// Three BLEND planes and an opaque one, each smaller than the one behind it, in fog that ends behind them.
Scene layered_scene() {
    Scene scene;
    add_plane(scene, -1, 0.2f, vec3(4, 0, 1), 0.5f);
    add_plane(scene, -2, 0.4f, vec3(0, 3, 1), 0.25f);
    add_plane(scene, -3, 0.9f, vec3(1, 1, 1), 0.75f);
    add_plane(scene, -5, 0.6f, vec3(2, 1, 0.5f));
    return scene;
}

Snapshot layered_snapshot(const Scene& scene) {
    Snapshot snapshot = snapshot_of(scene, {homogeneous_medium(0.3f, {vec3(-50, -50, -9), vec3(50, 50, 10)})});
    snapshot.background.color = vec3(0.7f, 0.2f, 0.1f);
    return snapshot;
}

// Colors reach 4 here and go through some ten roundings of 6e-8 each.
constexpr float rounding = 5e-6f;

void expect_alike(const Image<vec3>& a, const Image<vec3>& b, const char* what) {
    for (size_t i = 0; i < a.pixels.size(); ++i)
        ASSERT_LE(max_component(glm::abs(a.pixels[i] - b.pixels[i])), rounding) << what << " at pixel " << i;
}
void expect_alike(const Image<float>& a, const Image<float>& b, const char* what) {
    for (size_t i = 0; i < a.pixels.size(); ++i) {
        if (std::isinf(a.pixels[i]) && std::isinf(b.pixels[i])) continue;
        ASSERT_NEAR(a.pixels[i], b.pixels[i], rounding) << what << " at pixel " << i;
    }
}

void expect_same_picture(const View& view) {
    const Scene scene = layered_scene();
    const Snapshot snapshot = layered_snapshot(scene);
    const Layers shared = rendered(mode_of(prepare_emissive), view, snapshot);
    const Layers own = rendered(own_mode(prepare_follow), view, snapshot);
    expect_alike(own.color, shared.color, "color");
    expect_alike(own.inscatter, shared.inscatter, "inscatter");
    expect_alike(own.alpha, shared.alpha, "alpha");
    expect_alike(own.depth, shared.depth, "depth");
    expect_alike(own.transmittance, shared.transmittance, "transmittance");
    EXPECT_TRUE(same_bits(own.validity, shared.validity));
}
}

TEST(OwnSurfaces, MakeThePictureOfASharedModeThatComputesTheSame) {
    View view = plain_view({33, 21}, 3);
    view.camera.vertical_fov = 0.7f;
    expect_same_picture(view);
    view.crop_low = {10, 3}, view.crop_high = {30, 20};
    expect_same_picture(view);
}

TEST(OwnSurfaces, KnowTheNearAndFarPlane) {
    View view = plain_view({32, 20}, 2);
    view.camera.vertical_fov = 0.7f, view.camera.near = 1.5f;
    expect_same_picture(view);
    view.camera.far = 4;
    expect_same_picture(view);
}

namespace {
ScatterFunction prepare_half(const View&, const Snapshot&, const Settings&, History*) {
    return [](const RayBatch&, std::span<Scatter> results) {
        for (Scatter& result : results) result = {vec3(1), 0.5f, 0.75f, 2, vec3(2)};
    };
}
}

TEST(OwnSurfaces, LeaveAlphaAndDepthToTheRenderer) {
    const Scene scene = layered_scene();
    const Snapshot snapshot = layered_snapshot(scene);
    View view = plain_view({40, 40}, 1, 2.0f);
    view.background = false;
    const Layers layers = rendered(own_mode(prepare_half), view, snapshot);
    const auto expect = [&](ivec2 p, float alpha, float depth) {
        EXPECT_EQ(layers.color.at(p.x, p.y), vec3(3));
        EXPECT_EQ(layers.inscatter.at(p.x, p.y), vec3(1));
        EXPECT_EQ(layers.transmittance.at(p.x, p.y), 0.5f);
        EXPECT_EQ(layers.validity.at(p.x, p.y), 0.75f);
        EXPECT_EQ(layers.alpha.at(p.x, p.y), alpha);
        EXPECT_EQ(layers.depth.at(p.x, p.y), depth);
    };
    expect({20, 20}, 1, 5);                       // all four, the last one opaque
    expect({35, 20}, 1 - 0.5f * 0.25f, infinity); // x = 0.775: the third alone
    expect({0, 0}, 0.5f, infinity);               // x = -0.975: none
    expect({30, 20}, 1, 5);                       // x = 0.525: the third and the opaque one
}

namespace {
std::mutex seen_mutex;
std::vector<Ray> seen_rays;
std::vector<float> seen_near;

ScatterFunction prepare_record(const View&, const Snapshot&, const Settings&, History*) {
    return [](const RayBatch& batch, std::span<Scatter> results) {
        const std::lock_guard lock(seen_mutex);
        seen_rays.insert(seen_rays.end(), batch.rays.begin(), batch.rays.end());
        seen_near.insert(seen_near.end(), batch.clip_near.begin(), batch.clip_near.end());
        std::ranges::fill(results, Scatter{});
    };
}
}

TEST(OwnSurfaces, GetEveryCameraRayWholeAndOnce) {
    const Scene scene = layered_scene();
    const Snapshot snapshot = layered_snapshot(scene);
    View view = plain_view({9, 7}, 5);
    view.camera.near = 0.5f, view.camera.far = 100;
    seen_rays.clear(), seen_near.clear();
    rendered(own_mode(prepare_record), view, snapshot);
    ASSERT_EQ(seen_rays.size(), 9u * 7 * 5);
    ASSERT_EQ(seen_near.size(), seen_rays.size());
    for (size_t i = 0; i < seen_rays.size(); ++i) {
        const Ray& ray = seen_rays[i];
        EXPECT_EQ(ray.origin, vec3(0));
        EXPECT_NEAR(ray.t_max * -ray.direction.z, 100, 1e-4f);
        EXPECT_NEAR(seen_near[i] * -ray.direction.z, 0.5f, 1e-6f);
    }
}

TEST(OwnSurfaces, SplitTheLightByName) {
    Scene scene = layered_scene();
    Snapshot snapshot = layered_snapshot(scene);
    for (const char* name : {"key", "rim"}) {
        LightSource source;
        source.name = name;
        scene.lights.push_back(source);
        Light light;
        light.name = name, light.kind = LightKind::sun;
        snapshot.lights.push_back(light);
    }
    View view = plain_view({9, 9}, 2, 2.0f);
    view.fog_parts = true;
    const Layers layers = rendered(own_mode(prepare_follow), view, snapshot, FrameOptions{});
    ASSERT_EQ(layers.lights.size(), 2u);
    for (size_t i = 0; i < layers.color.pixels.size(); ++i)
        for (int l = 0; l < 2; ++l) {
            const vec3 part = layers.lights[l].second.pixels[i], whole = layers.inscatter.pixels[i];
            ASSERT_LE(max_component(glm::abs(part - whole * ((l + 1) / 3.0f))), rounding);
        }
}

TEST(OwnSurfaces, HaveTheSameBitsForAnyThreadCountAndCrop) {
    const Scene scene = layered_scene();
    const Snapshot snapshot = layered_snapshot(scene);
    View view = batched_view({75, 46}, 16, 8);
    FrameOptions options;
    options.halves = true;
    for (const Mode& mode : {own_mode(prepare_everything), mode_of(prepare_everything)}) {
        view.crop_low = view.crop_high = ivec2(0);
        const auto made = [&] { return rendered(mode, view, snapshot, options); };
        const Layers one = on_threads(1, made), two = on_threads(2, made);
        view.crop_low = {33, 5}, view.crop_high = {70, 45};
        const Layers crop = rendered(mode, view, snapshot, options);
        const auto expect_same = [&](auto layer, const char* what) {
            EXPECT_TRUE(same_bits(one.*layer, two.*layer)) << what;
            EXPECT_TRUE(same_bits(crop.*layer, cut(one.*layer, view.crop_low, view.crop_high))) << what;
        };
        expect_same(&Layers::color, "color");
        expect_same(&Layers::inscatter, "inscatter");
        expect_same(&Layers::alpha, "alpha");
        expect_same(&Layers::depth, "depth");
        expect_same(&Layers::transmittance, "transmittance");
        expect_same(&Layers::variance, "variance");
        expect_same(&Layers::inscatter_variance, "variance of inscatter");
        expect_same(&Layers::half_a, "first half");
        expect_same(&Layers::half_b, "second half");
    }
}
}
