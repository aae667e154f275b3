// Lit stretches of sixteen rays at once against those of one ray at a time.
#include "scene/scene.h"
#include "support/meshes.h"
#include "trace/occlusion/occluders.h"
#include "trace/shadows/intervals/shadow_slices.h"
#include "trace/shadows/shadow_rays.h"

#include "base/random.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
// Small triangles anywhere in a box of 4 m.
ShadowSlices soup(int triangles, uint32_t seed) {
    Scene scene;
    Mesh mesh;
    for (uint32_t i = 0; i < static_cast<uint32_t>(triangles); ++i) {
        const auto random = [&](uint32_t corner) {
            return vec3(to_unit(hash(seed, i, 3 * corner)), to_unit(hash(seed, i, 3 * corner + 1)),
                        to_unit(hash(seed, i, 3 * corner + 2)));
        };
        for (uint32_t corner = 0; corner < 3; ++corner)
            mesh.positions.push_back(4.0f * random(0) - 2.0f + 0.6f * random(corner + 1));
        mesh.triangles.push_back(glm::uvec3(0, 1, 2) + 3 * i);
    }
    add_mesh(scene, std::move(mesh));
    return make_shadow_slices(Occluders::make(scene, 0, nullptr)->shadow_triangles());
}

void expect_same(const ShadowSlices& slices, std::span<const Ray> rays, std::span<const LightPoint> points) {
    std::vector<Interval<double>> together[16], alone;
    find_lit(coherent_slices(slices, rays, points), rays, points, together);
    for (size_t i = 0; i < rays.size(); ++i) {
        find_lit(slices, rays[i], points[i], alone);
        EXPECT_LT(difference(together[i], alone), 1e-9) << i;
        for (size_t k = 1; k < together[i].size(); ++k) EXPECT_GT(together[i][k].low, together[i][k - 1].high);
    }
}

std::vector<Ray> bundle(uint32_t seed, size_t count) {
    const auto u = [&](uint32_t k) { return to_unit(hash(seed, k)); };
    const vec3 eye(8 * u(0) - 4, 8 * u(1) - 4, 5), to(3 * u(2) - 1.5f, 3 * u(3) - 1.5f, -2);
    std::vector<Ray> rays;
    for (uint32_t i = 0; i < count; ++i) {
        const vec3 off(0.02f * static_cast<float>(i % 4), 0.02f * static_cast<float>(i / 4), 0);
        rays.push_back({eye, glm::normalize(to + off - eye), 3 + 8 * u(4 + i)});
    }
    return rays;
}

TEST(ShadowSlicesPacket, AgreesWithOneRayAtATime) {
    const ShadowSlices slices = soup(400, 5);
    for (uint32_t k = 0; k < 40; ++k) {
        const auto u = [&](uint32_t i) { return to_unit(hash(k, 77u, i)); };
        const std::vector<Ray> rays = bundle(k, k % 2 ? 16 : 5);
        std::vector<LightPoint> suns, lamps, balls;
        for (uint32_t i = 0; i < rays.size(); ++i) {
            const auto v = [&](uint32_t axis) { return to_unit(hash(k, i, 3u + axis)); };
            const dvec3 near(u(0) * 6 - 3, u(1) * 6 - 3, u(2) * 4 - 2), apart = 0.1 * dvec3(v(0), v(1), v(2));
            suns.push_back({glm::normalize(dvec3(u(0) - 0.5, u(1) + 0.1, u(2) - 0.5) + apart), true});
            lamps.push_back({near + apart, false, near + apart, 0});
            balls.push_back({near + apart, false, near, 0.4}); // some triangles lie in it, in part or whole
        }
        expect_same(slices, rays, suns), expect_same(slices, rays, lamps), expect_same(slices, rays, balls);
    }
}

TEST(ShadowSlicesPacket, EmptyRaysAndNoTriangles) {
    std::vector<Ray> rays = bundle(3, 16);
    rays[2].t_max = 0, rays[5].direction.x = std::nanf("");
    const std::vector<LightPoint> points(16, LightPoint{{0, 1, 0}, true});
    std::vector<Interval<double>> lit[16];
    find_lit(ShadowSlices{}, rays, points, lit);
    for (size_t i = 0; i < 16; ++i) EXPECT_EQ(lit[i].size(), i == 2 || i == 5 ? 0u : 1u);
    find_lit(soup(50, 1), rays, points, lit);
    EXPECT_TRUE(lit[2].empty() && lit[5].empty());
}
}
}
