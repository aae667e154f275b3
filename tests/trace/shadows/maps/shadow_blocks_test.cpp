// Boxes decided by blocks of a shadow map's texels against single look-ups, and texels left out against all of them.

#include "base/random.h"
#include "scene/light.h"
#include "scene/scene.h"
#include "support/meshes.h"
#include "trace/occlusion/occluders.h"
#include "trace/shadows/maps/shadow_map.h"
#include "trace/small_scenes.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/medium.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
// A street of blocks under a slanted sun, in a box of fog.
struct Street {
    Scene scene;
    Snapshot snapshot;
    View view;
    Light light;

    Street() {
        add_mesh(scene, quad({-40, 0, -100}, {80, 0, 0}, {0, 0, 110}));
        for (int i = 0; i < 10; ++i) {
            const float z = -10.0f * static_cast<float>(i);
            add_mesh(scene, box_of(vec3(3, 0, z - 2), vec3(5, 4, z)));
        }
        snapshot.scene = &scene;
        snapshot.occluders = Occluders::make(scene, 0, nullptr);
        Medium medium;
        medium.density.bounds = medium.world_bounds = {vec3(-40, 0, -100), vec3(40, 10, 10)};
        snapshot.media = {medium};
        snapshot.bounds = medium.world_bounds;
        view.camera = look_at({0, 1.7f, 8}, {0, 1.7f, -100}, {0, 1, 0}, 0.8f);
        view.size = {160, 90};
        light.kind = LightKind::sun, light.direction = glm::normalize(vec3(-1, -0.6f, -0.2f));
    }
    ShadowMap map(int pcf, float bias = 0) const { return make_shadow_map(view, snapshot, light, {256, 3, pcf, bias}); }
    // A place on one of the picture's rays, in the fog.
    vec3 seen_point(uint32_t i) const {
        const vec2 pixel(random_unit(i, 0, 0, 2) * 160, random_unit(i, 0, 1, 2) * 90);
        const Ray ray = camera_ray(view.camera, view.size, pixel);
        const Interval<float> fog = clip(snapshot.media[0].world_bounds, ray.origin, ray.direction, {0, infinity});
        return ray.at(glm::mix(fog.low, fog.high, random_unit(i, 0, 2, 2)));
    }
};

void lit_shares_at(const ShadowMap& map, const std::array<vec3, 16>& points, float* share) {
    alignas(64) float x[16], y[16], z[16];
    for (size_t i = 0; i < 16; ++i) x[i] = points[i].x, y[i] = points[i].y, z[i] = points[i].z;
    lit_fractions(map, x, y, z, share);
}

TEST(ShadowBlocks, NoLookUpContradictsABox) {
    const Street street;
    for (const auto& [pcf, bias] : {std::pair{0, 0.0f}, {1, 0.0f}, {2, 0.0f}, {0, 0.5f}}) {
        const ShadowMap map = street.map(pcf, bias);
        const mat3 to_world = glm::transpose(map.world_to_map);
        int decided[3] = {0, 0, 0};
        for (uint32_t i = 0; i < 8000; ++i) {
            const vec3 middle = map.world_to_map * (street.seen_point(i) - map.position);
            const vec3 half = std::exp2(-8 * random_unit(i, 1, 0, 3)) * vec3(1, 0.3f, 0.6f);
            const Lit lit = lit_in_box(map, middle - half, middle + half);
            ++decided[static_cast<int>(lit)];
            if (lit == Lit::some) continue;
            std::array<vec3, 16> points;
            for (uint32_t k = 0; k < 16; ++k) {
                const vec3 at(random_unit(i, k, 0, 4), random_unit(i, k, 1, 4), random_unit(i, k, 2, 4));
                points[k] = map.position + to_world * (middle + half * (1.998f * at - 0.999f));
            }
            alignas(64) float share[16];
            lit_shares_at(map, points, share);
            for (const float s : share)
                ASSERT_NEAR(s, lit == Lit::all ? 1 : 0, 1e-6f) << i << " " << pcf << " " << bias;
        }
        // The shadows of the blocks, the street between them, and edges.
        for (const int count : decided) EXPECT_GT(count, 20) << pcf << " " << bias;
    }
}

TEST(ShadowBlocks, BoxesAcrossPicturesAndBesideThemAreNeverWrong) {
    const Street street;
    const ShadowMap map = street.map(1);
    EXPECT_EQ(lit_in_box(map, vec3(-1e6f), vec3(1e6f)), Lit::some);
    const vec3 beside(1e5f, 0, 0);
    EXPECT_EQ(lit_in_box(map, beside - 1.0f, beside + 1.0f), Lit::all);
    EXPECT_EQ(lit_in_box(map, vec3(NAN), vec3(NAN)), Lit::some);
    EXPECT_EQ(lit_in_box(ShadowMap{}, vec3(-1), vec3(1)), Lit::all);
}

TEST(ShadowBlocks, UnseenTexelsAreNeverLookedUp) {
    // The same pictures filled for this view, and for one that sees everything from far away.
    const Street street;
    View everything = street.view;
    everything.camera = look_at({0, 2000, 0}, {0, 0, 0}, {0, 0, 1}, 0.5f);
    std::vector<Light> lights{street.light, street.light, street.light};
    lights[1].kind = LightKind::spot, lights[1].position = {-30, 7, 5}, lights[1].outer_cone = 0.7f;
    lights[1].direction = glm::normalize(vec3(1, -0.5f, 0.1f));
    lights[2].kind = LightKind::point, lights[2].position = {-30, 3, 9};
    for (const Light& light : lights)
        for (const int pcf : {0, 2}) {
            const ShadowMap map = make_shadow_map(street.view, street.snapshot, light, {256, 3, pcf, 0});
            ShadowMap whole = map;
            fill_shadow_map(everything, street.snapshot, light, whole);
            const auto unseen = [](const ShadowMap& m) { return std::ranges::count(m.depth, unseen_depth); };
            EXPECT_GT(unseen(map), unseen(whole) + static_cast<int64_t>(map.depth.size() / 20));
            for (uint32_t i = 0; i < 500; ++i) {
                std::array<vec3, 16> points;
                for (uint32_t k = 0; k < 16; ++k) points[k] = street.seen_point(16 * i + k);
                alignas(64) float share[16], expected[16];
                lit_shares_at(map, points, share), lit_shares_at(whole, points, expected);
                for (int k = 0; k < 16; ++k)
                    ASSERT_EQ(share[k], expected[k]) << static_cast<int>(light.kind) << " " << pcf << " " << i;
            }
        }
}
}
}
