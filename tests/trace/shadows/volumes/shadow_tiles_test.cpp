// Shadow volumes sorted into tiles of the picture.
#include "scene/light.h"
#include "scene/lights/light_reach.h"
#include "trace/shadows/volumes/shadow_stage.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
TEST(ShadowTiles, HoldAllThatTheirRaysCross) {
    Camera cameras[4] = {look_at({3, 2, 5}, {0, 0, 0}, {0, 1, 0}, 0.9f),
                         look_at({0, 0.1f, 0}, {1, 0, 0.3f}, {0, 1, 0}, 1.4f),
                         look_at({3, 2, 5}, {0, 0, 0}, {0, 1, 0}, 0.9f), look_at({0, 5, 0}, {0, 0, 0}, {1, 0, 0}, 1)};
    cameras[2].ortho_height = 5, cameras[3].ortho_height = 7;
    const ivec2 size(150, 100);
    for (const LightPoint& light : lights) {
        const Stage stage = stage_of(random_boxes(12), light);
        for (const Camera& camera : cameras) {
            const ShadowView view = view_from(stage.volumes, camera, size, 0.5f);
            ASSERT_EQ(view.tiles, ivec2(19, 13));
            size_t crossed = 0;
            for (int i = 0; i < 400; ++i) {
                const vec2 pixel(static_cast<float>(i * 7919 % 1500) / 10, static_cast<float>(i * 104729 % 1000) / 10);
                Ray ray = camera_ray(camera, size, pixel);
                ray.t_max = i % 3 ? 50 : 4;
                const int tile = static_cast<int>(pixel.y) / shadow_tile_side * view.tiles.x +
                                 static_cast<int>(pixel.x) / shadow_tile_side;
                const Counted in_tile = crossings_of(view, ray, tile), all = crossings_of(view, ray);
                EXPECT_EQ(in_tile.crossings.size(), all.crossings.size());
                crossed += all.crossings.size();
            }
            EXPECT_GT(crossed, 100u);
        }
    }
}

// Of a spot only the tiles that its beam crosses hold anything, and those all that others would hold.
TEST(ShadowTiles, OfABeamAreThoseItIsSeenIn) {
    Camera cameras[4] = {look_at({3, 2, 5}, {0, 0, 0}, {0, 1, 0}, 0.9f),
                         look_at({0.5f, 0, 0}, {0.5f, 3, -0.3f}, {1, 0, 0}, 1),    // in the beam, towards the lamp
                         look_at({0.4f, 3.2f, -0.4f}, {0.5f, 0, 0}, {1, 0, 0}, 1), // as the lamp looks
                         look_at({3, 2, 5}, {0, 0, 0}, {0, 1, 0}, 0.9f)};
    cameras[3].ortho_height = 5;
    const ivec2 size(150, 100);
    Light spot;
    spot.kind = LightKind::spot, spot.position = vec3(0.5f, 3, -0.4f);
    spot.direction = glm::normalize(vec3(0.1f, -1, 0.15f));
    const auto mesh = std::make_shared<const ShadowMesh>(make_shadow_mesh(triangles_of(random_boxes(30))));
    for (const float half_angle : {0.05f, 0.3f, 1.2f})
        for (const Camera& camera : cameras) {
            spot.outer_cone = half_angle;
            const LightPoint point = center_of(spot);
            const ShadowView all = view_from(make_shadow_volumes(mesh, point), camera, size, 0.5f);
            const ShadowView beam = view_from(make_shadow_volumes(mesh, point, shadow_cone(spot)), camera, size, 0.5f);
            EXPECT_LE(beam.side_tiles.faces.size(), all.side_tiles.faces.size());
            int inside = 0;
            for (int i = 0; i < 3000; ++i) {
                const vec2 pixel(static_cast<float>(i * 7919 % 1500) / 10, static_cast<float>(i * 104729 % 1000) / 10);
                Ray ray = camera_ray(camera, size, pixel);
                ray.t_max = 50;
                if (light_reach(spot, ray, {0, ray.t_max}).empty()) continue;
                const int tile = static_cast<int>(pixel.y) / shadow_tile_side * beam.tiles.x +
                                 static_cast<int>(pixel.x) / shadow_tile_side;
                EXPECT_EQ(crossings_of(beam, ray, tile).crossings.size(), crossings_of(all, ray).crossings.size());
                ++inside;
            }
            EXPECT_GT(inside, 10);
        }
    spot.outer_cone = 0.05f;
    const auto faces = [&](std::optional<ShadowCone> reach) {
        return view_from(make_shadow_volumes(mesh, center_of(spot), reach), cameras[0], size, 0.5f)
            .side_tiles.faces.size();
    };
    EXPECT_LT(5 * faces(shadow_cone(spot)), faces({}));
    spot.kind = LightKind::point;
    EXPECT_FALSE(shadow_cone(spot));
}
}
}
