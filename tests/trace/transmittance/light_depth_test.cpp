
#include "scene/light.h"
#include "support/random_points.h"
#include "trace/snapshot.h"
#include "trace/transmittance/depths_at.h"
#include "trace/transmittance/light_grid.h"
#include "volume/bricks/sparse_volume.h"
#include "volume/fog_fixtures.h"
#include "volume/medium.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace tyndall {
namespace {
using namespace test;

float depth_at(const LightDepth& depth, vec3 point) { return depths_at(depth, {point})[0]; }

// The path from a point to the light, in double where it matters.
Light with_radius(Light light, float radius) {
    light.radius = radius;
    return light;
}

double exact_depth(const std::vector<Medium>& media, const Light& light, vec3 point) {
    if (is_distant(light)) return optical_depth(media, {point, -light.direction});
    const vec3 towards = light.position - point;
    const float distance = glm::length(towards);
    return optical_depth(media, {point, towards / distance, std::max(0.0f, distance - light.radius)});
}

std::vector<vec3> points_in(const Box& box, uint32_t count, uint32_t seed = 1) {
    std::vector<vec3> points;
    for (uint32_t i = 0; i < count; ++i) points.push_back(random_point(i, seed, box));
    return points;
}

void expect_exact(const std::vector<Medium>& media, const Light& light, const Box& where) {
    const Snapshot snapshot = snapshot_of(media);
    const LightDepth depth = make_light_depth(snapshot, light, LightTransmittance::grid, 16);
    const std::vector<vec3> points = points_in(where, 512);
    const std::vector<float> found = depths_at(depth, points);
    for (size_t i = 0; i < points.size(); ++i) {
        const double expected = exact_depth(media, light, points[i]);
        EXPECT_NEAR(found[i], expected, 1e-5 * std::max(1.0, expected)) << i;
    }
}

const Box around{vec3(-3, -2, -4), vec3(5, 6, 3)};

TEST(LightDepth, HomogeneousFogIsExact) {
    const mat4 turned = glm::rotate(glm::scale(glm::translate(mat4(1), vec3(1, 2, -1)), vec3(1, 2, 0.5f)), 0.7f,
                                    glm::normalize(vec3(1, 2, 3)));
    const std::vector<Medium> media = {placed(homogeneous_medium(0.3f, {vec3(-1), vec3(1.5f, 1, 2)}), turned),
                                       homogeneous_medium(0.2f, {vec3(-2, 0, -3), vec3(2, 1, 1)})};
    expect_exact(media, sun_light(vec3(0.3f, -1, 0.2f)), around);
    expect_exact(media, sun_light(vec3(0, -1, 0)), around);
    expect_exact(media, point_light(vec3(0.5f, 3, -1)), around);
    expect_exact(media, with_radius(point_light(vec3(0.5f, 0.5f, -1)), 0.75f), around);
    expect_exact(media, spot_light(vec3(4, 5, 2), {-4, -5, -2}, 1, 0, 0.5f), around);
}

TEST(LightDepth, FogWithoutEndIsExactForLocalLightsAndHidesTheSun) {
    const std::vector<Medium> media = {homogeneous_medium(0.3f)};
    expect_exact(media, point_light(vec3(9, 3, -1)), around);
    const Snapshot snapshot = snapshot_of(media);
    const LightDepth depth = make_light_depth(snapshot, sun_light(vec3(0, -1, 0)), LightTransmittance::grid, 16);
    EXPECT_EQ(std::exp(-depth_at(depth, vec3(1, 2, 3))), 0);
}

TEST(LightDepth, HeightFogIsExact) {
    for (const float falloff : {0.05f, 0.8f, 500.0f}) {
        const std::vector<Medium> endless = {height_fog(0.3f, 0.5f, falloff)};
        const std::vector<Medium> boxed = {height_fog(0.3f, 0.5f, falloff, {vec3(-2, -1, -3), vec3(3, 4, 2)})};
        for (const std::vector<Medium>& media : {endless, boxed}) {
            expect_exact(media, sun_light(vec3(0.3f, -1, 0.2f)), around);
            expect_exact(media, point_light(vec3(2, 3, -1)), around);
            expect_exact(media, point_light(vec3(2, -1.5f, -1)), around);
            expect_exact(media, spot_light(vec3(4, 0.5f, 2), {-4, -0.5f, -2}, 1, 0, 0.5f), around);
        }
        expect_exact(boxed, sun_light(vec3(1, 0, 0)), around);
        expect_exact(boxed, sun_light(vec3(0.1f, 1, 0)), around);
    }
}

TEST(LightDepth, LowSunInHeightFog) {
    // σ H / sin(elevation) · exp(-(y - base) / H)
    const Snapshot snapshot = snapshot_of({height_fog(0.02f, 1, 4)});
    const float elevation = 0.05f;
    const LightDepth depth = make_light_depth(snapshot, sun_light(vec3(std::cos(elevation), -std::sin(elevation), 0)),
                                              LightTransmittance::grid, 16);
    for (const float y : {1.0f, 3.0f, 9.0f, 30.0f}) {
        const double expected = 0.02 * 4 / std::sin(double(elevation)) * std::exp(-(y - 1) / 4.0);
        EXPECT_NEAR(depth_at(depth, vec3(20, y, -7)), expected, 2e-5 * expected);
    }
}

// A constant box of voxels from every side, by its grid: before it, beside it, behind it.
TEST(LightDepth, GridKnowsBeforeBesideAndBehind) {
    const Snapshot snapshot = snapshot_of({medium_of(constant_box(16, 1), 0.25f)});
    const float across = 16 * 0.25f; // the rim fades over a voxel to each side: the same integral
    const LightDepth down = make_light_depth(snapshot, sun_light(vec3(0, -1, 0)), LightTransmittance::grid, 64);
    EXPECT_NEAR(depth_at(down, vec3(7, 30, 7)), 0, 1e-6);
    EXPECT_NEAR(depth_at(down, vec3(7, -30, 7)), across, 1e-3);
    EXPECT_NEAR(depth_at(down, vec3(7, 7.5f, 7)), across / 2, 1e-3);
    EXPECT_EQ(depth_at(down, vec3(30, -30, 7)), 0);

    for (const Light& light :
         {spot_light(vec3(7.5f, 60, 7.5f), {0, -1, 0}, 1, 0, 0.3f), point_light(vec3(7.5f, 60, 7.5f))}) {
        const LightDepth depth = make_light_depth(snapshot, light, LightTransmittance::grid, 64);
        EXPECT_EQ(depth.grid.projection, LightProjection::perspective);
        EXPECT_NEAR(depth_at(depth, vec3(7.5f, 40, 7.5f)), 0, 1e-6);
        EXPECT_NEAR(depth_at(depth, vec3(7.5f, -30, 7.5f)), across, 5e-3);
        EXPECT_NEAR(depth_at(depth, vec3(7.5f, 7.5f, 7.5f)), across / 2, 0.02f);
        EXPECT_EQ(depth_at(depth, vec3(7.5f, 80, 7.5f)), 0);
    }
    const LightDepth inside = make_light_depth(snapshot, point_light(vec3(7.5f)), LightTransmittance::grid, 64);
    EXPECT_EQ(inside.grid.projection, LightProjection::all_around);
    for (const vec3 axis : {vec3(1, 0, 0), vec3(0, -1, 0), vec3(0, 0, 1), vec3(0, 0, -1)})
        EXPECT_NEAR(depth_at(inside, vec3(7.5f) + 50.0f * axis), across / 2, 5e-3);
}

TEST(LightDepth, OffAverageAndInactive) {
    const Snapshot snapshot =
        snapshot_of({medium_of(constant_box(16, 1), 0.25f), homogeneous_medium(0.1f, {vec3(0), vec3(10)})});
    const Light light = sun_light(vec3(0, -1, 0));
    EXPECT_EQ(depth_at(make_light_depth(snapshot, light, LightTransmittance::off, 32), vec3(5)), 0);

    const LightDepth average = make_light_depth(snapshot, light, LightTransmittance::average, 32);
    // Bounds of 17³. The voxels fill 16² columns of them with 4 in all, 2 on average over a column; the box of 10³
    // fills 10² columns: 1 on the meter below it, 0.5 on average within.
    const float mean = (256 * 2.0f + 100 * (1 * 1 + 10 * 0.5f) / 17) / 289;
    EXPECT_NEAR(depth_at(average, vec3(5)), mean, 0.01f * mean);
    EXPECT_EQ(depth_at(average, vec3(500)), depth_at(average, vec3(5)));

    const float nan = std::numeric_limits<float>::quiet_NaN();
    float x[16], y[16], z[16], out[16];
    int32_t active[16];
    for (int lane = 0; lane < 16; ++lane) {
        active[lane] = lane % 2 ? -1 : 0;
        x[lane] = y[lane] = z[lane] = lane % 2 ? 5 : nan;
    }
    for (const LightTransmittance method :
         {LightTransmittance::average, LightTransmittance::grid, LightTransmittance::marched})
        for (const Light& source : {light, point_light(vec3(5, 30, 5)), point_light(vec3(4))}) {
            light_depths(make_light_depth(snapshot, source, method, 32), x, y, z, active, out);
            for (int lane = 0; lane < 16; lane += 2) EXPECT_EQ(out[lane], 0);
            for (int lane = 1; lane < 16; lane += 2) EXPECT_GT(out[lane], 0);
        }
}

TEST(LightDepth, MarchedIsExact) {
    const std::vector<Medium> media = {medium_of(volume_of(ivec3(0), ivec3(30, 20, 17), exact_noise), 0.05f),
                                       homogeneous_medium(0.01f, {vec3(0), vec3(10)})};
    const Snapshot snapshot = snapshot_of(media);
    for (const Light& light : {sun_light(vec3(0.3f, -1, 0.2f)), with_radius(point_light(vec3(9, 8, 7)), 0.5f),
                               spot_light(vec3(9, 40, 7), {0, -40, 2}, 1, 0, 0.4f)}) {
        const LightDepth depth = make_light_depth(snapshot, light, LightTransmittance::marched, 16);
        for (const vec3 point : points_in({vec3(-5), vec3(35)}, 64)) {
            const double expected = exact_depth(media, light, point);
            EXPECT_NEAR(depth_at(depth, point), expected, 1e-5 * std::max(1.0, expected));
        }
    }
}

TEST(LightDepth, MediaShareOneGrid) {
    const SparseVolume volume = volume_of(ivec3(0), ivec3(30, 20, 17), exact_noise);
    const Snapshot one = snapshot_of({medium_of(volume, 0.05f)});
    const Snapshot two = snapshot_of({medium_of(volume, 0.02f), medium_of(volume, 0.03f)});
    const Light light = sun_light(vec3(0.3f, -1, 0.2f));
    const LightDepth a = make_light_depth(one, light, LightTransmittance::grid, 32);
    const LightDepth b = make_light_depth(two, light, LightTransmittance::grid, 32);
    for (const vec3 point : points_in({vec3(0), vec3(30, 20, 17)}, 64))
        EXPECT_NEAR(depth_at(a, point), depth_at(b, point), 1e-5);
}

TEST(LightDepth, NoFogAndNothingInTheCone) {
    const Snapshot none = snapshot_of({});
    EXPECT_EQ(depth_at(make_light_depth(none, sun_light(vec3(0, -1, 0)), LightTransmittance::grid, 64), vec3(1)), 0);
    const Snapshot fog = snapshot_of({medium_of(constant_box(16, 1))});
    const Light away = spot_light(vec3(7, 40, 7), {0, 1, 0}, 1, 0, 0.3f);
    const LightDepth depth = make_light_depth(fog, away, LightTransmittance::grid, 64);
    EXPECT_TRUE(depth.grid.empty());
    EXPECT_EQ(depth_at(depth, vec3(7, 60, 7)), 0);
}

// Fog some thousands of voxels across: cells of half a voxel would take gigabytes. Their size doubles until they fit.
TEST(LightDepth, MemoryIsBounded) {
    SparseVolume there = constant_box(16, 1);
    there.index_to_world = glm::translate(dmat4(1), dvec3(800, -4000, 800));
    const Medium here = medium_of(constant_box(16, 1)), far = medium_of(there);
    const Medium* const media[] = {&here, &far};
    for (const Light& light :
         {sun_light(vec3(0, -1, 0)), point_light(vec3(7)), spot_light(vec3(7, 40, 7), {0, -1, 0}, 1, 0, 0.35f)}) {
        const LightDepthGrid grid = fitted_grid(media, light, 100000);
        EXPECT_LE(int64_t{grid.size.x} * grid.size.y * grid.size.z * 4, int64_t{256} << 20);
        EXPECT_GE(int64_t{grid.size.x} * grid.size.y * grid.size.z * 4, int64_t{30} << 20);
    }
}

// Fog far from the origin: the grid's coordinates must not drown in rounding.
TEST(LightDepth, FarFromTheOrigin) {
    SparseVolume volume = volume_of(ivec3(0), ivec3(30, 20, 17), exact_noise);
    const auto depths = [&](vec3 shift) {
        volume.index_to_world = glm::translate(dmat4(1), dvec3(shift));
        const Snapshot snapshot = snapshot_of({medium_of(volume, 0.05f)});
        std::vector<vec3> points = points_in({vec3(0), vec3(30, 20, 17)}, 64);
        for (vec3& point : points) point = glm::floor(point * 64.0f) / 64.0f + shift;
        return depths_at(make_light_depth(snapshot, sun_light(vec3(0.3f, -1, 0.2f)), LightTransmittance::grid, 64),
                         points);
    };
    const std::vector<float> near = depths(vec3(0)), far = depths(vec3(65536, 0, -32768));
    for (size_t i = 0; i < near.size(); ++i) EXPECT_NEAR(near[i], far[i], 2e-3) << i;
}
}
}
