// How far light-aligned grids are from the exact optical depth.
#include "scene/light.h"
#include "support/random_points.h"
#include "support/threads.h"
#include "trace/transmittance/light_grid.h"
#include "volume/medium.h"

#include "base/parallel.h"
#include "trace/snapshot.h"
#include "volume/fog_fixtures.h"
#include "volume/noise/noise.h"

#include <gtest/gtest.h>

#include <array>
#include <tuple>

namespace tyndall {
namespace {
using namespace test;

constexpr int side = 96;

// Five octaves of noise, a third of the box to the first cell; half of the light of a path comes through on average.
const Medium& noise_fog() {
    static const Medium fog = [] {
        FractalNoise noise;
        noise.scale = side / 3.0f;
        noise.seed = 4;
        std::vector<float> x(side * side * side), y(x.size()), z(x.size()), values(x.size());
        for (int i = 0; i < side * side * side; ++i) {
            x[i] = static_cast<float>(i / (side * side)), y[i] = static_cast<float>(i / side % side);
            z[i] = static_cast<float>(i % side);
        }
        fractal_noise(noise, 0, x, y, z, values);
        const auto density = [&](int i, int j, int k) {
            return std::clamp(0.5f + 3 * values[(i * side + j) * side + k], 0.0f, 1.0f);
        };
        return medium_of(volume_of(ivec3(0), ivec3(side - 1), density), 0.033f);
    }();
    return fog;
}

struct Accuracy {
    double rmse = 0, bias = 0, mean = 0;
};

Accuracy accuracy_of(const LightDepth& depth, const Medium& fog, const std::vector<vec3>& points) {
    Accuracy result;
    const Light& light = depth.light;
    for (size_t first = 0; first + 16 <= points.size(); first += 16) {
        float v[3][16], found[16];
        int32_t active[16];
        for (int lane = 0; lane < 16; ++lane) {
            for (int axis = 0; axis < 3; ++axis) v[axis][lane] = points[first + lane][axis];
            active[lane] = -1;
        }
        light_depths(depth, v[0], v[1], v[2], active, found);
        for (int lane = 0; lane < 16; ++lane) {
            Ray ray{points[first + lane], -light.direction};
            if (!is_distant(light)) {
                const vec3 towards = light.position - ray.origin;
                ray.t_max = glm::length(towards), ray.direction = towards / ray.t_max;
            }
            const double exact = std::exp(-optical_depth(fog, ray)), error = std::exp(-double{found[lane]}) - exact;
            result.rmse += error * error, result.bias += error, result.mean += exact;
        }
    }
    const double count = static_cast<double>(points.size());
    return {std::sqrt(result.rmse / count), result.bias / count, result.mean / count};
}

// RMSE of the transmittance with cells of 1, 2 and 4 voxels where the fog is.
void expect_accuracy(const Light& light, const std::vector<vec3>& points, float resolution, const double (&most)[3],
                     const char* name) {
    Snapshot snapshot;
    snapshot.media = {noise_fog()};
    for (int level = 0; level < 3; ++level) {
        const LightDepth depth = make_light_depth(snapshot, light, LightTransmittance::grid,
                                                  static_cast<int>(std::lround(resolution / (1 << level))));
        const Accuracy accuracy = accuracy_of(depth, snapshot.media[0], points);
        const ivec3 size = depth.grid.size;
        std::printf("%s 1/%d: %dx%dx%d, rmse %.4f, bias %+.4f, mean %.3f\n", name, 1 << level, size.x, size.y, size.z,
                    accuracy.rmse, accuracy.bias, accuracy.mean);
        EXPECT_LT(accuracy.rmse, most[level]) << name << " 1/" << (1 << level);
        EXPECT_LT(std::abs(accuracy.bias), 0.25 * most[level]) << name << " 1/" << (1 << level);
    }
}

std::vector<vec3> points_in_fog(const std::function<bool(vec3)>& wanted) {
    std::vector<vec3> points;
    for (uint32_t i = 0; points.size() < 4096; ++i) {
        const vec3 point = random_point(i, 5, {vec3(0), vec3(side - 1)});
        if (wanted(point)) points.push_back(point);
    }
    return points;
}

// A spot over the fog that aims at its middle, and points of the fog in its beam.
Light spot_above(float half_angle) {
    Light light;
    light.kind = LightKind::spot, light.outer_cone = half_angle;
    light.position = vec3(side / 2, 1.6f * side, side / 3);
    light.direction = glm::normalize(vec3(side / 2) - light.position);
    return light;
}
std::vector<vec3> points_in_beam(const Light& light) {
    return points_in_fog(
        [&](vec3 p) { return dot(glm::normalize(p - light.position), light.direction) > std::cos(light.outer_cone); });
}

TEST(LightGrid, SunIsAccurate) {
    Light light;
    light.kind = LightKind::sun;
    light.direction = glm::normalize(vec3(0.4f, -1, 0.25f));
    // Seen along the light, the box is about 1.3 of its sides wide.
    expect_accuracy(light, points_in_fog([](vec3) { return true; }), 1.3f * side, {0.004, 0.014, 0.04}, "sun");
}

TEST(LightGrid, SpotIsAccurate) {
    const Light light = spot_above(0.3f);
    // Cells of a voxel at the middle of the fog, 1.1 sides away.
    expect_accuracy(light, points_in_beam(light), 2 * std::tan(0.3f) * 1.1f * side, {0.004, 0.014, 0.04}, "spot");
}

TEST(LightGrid, PointInsideTheFogIsAccurate) {
    Light light;
    light.position = vec3(0.45f, 0.4f, 0.55f) * float(side);
    expect_accuracy(light, points_in_fog([](vec3) { return true; }), side, {0.007, 0.02, 0.05}, "point");
}

TEST(LightGrid, PointBesideTheFogIsAccurate) {
    Light light;
    light.position = vec3(-0.5f, 1.4f, 0.3f) * float(side);
    // The box is seen across 2·tan(view angle); its middle is 1.4 sides away.
    expect_accuracy(light, points_in_fog([](vec3) { return true; }), 1.6f * side, {0.006, 0.016, 0.045}, "aside");
}

// A beam a voxel wide at the fog asks for few more cells than voxels, but for more where more are asked for.
TEST(LightGrid, NarrowBeamsNeedFewCellsFinerThanVoxels) {
    Light light = spot_above(0.02f);
    expect_accuracy(light, points_in_beam(light), 256, {0.004, 0.004, 0.004}, "beam");
    const Medium* const fog[] = {&noise_fog()};
    // Some 150 voxels away it is 6 voxels wide or 0.6; cells are up to 9 % finer than wanted, and both edges have
    // corners.
    for (const auto& [angle, across, along] : {std::tuple{0.02f, 15, 200}, std::tuple{0.002f, 4, 200}}) {
        light.outer_cone = angle;
        const LightDepthGrid grid = fitted_grid(fog, light, 64), fine = fitted_grid(fog, light, 1024);
        EXPECT_LE(std::max(grid.size.x, grid.size.y), across);
        EXPECT_LE(grid.size.z, along);
        EXPECT_LE(std::max(fine.size.x, fine.size.y), 4 * across);
        EXPECT_LE(fine.size.z, 4 * along);
        EXPECT_GT(fine.size.z, 3 * grid.size.z);
    }
    Light lamp, sun;
    lamp.position = vec3(side / 2), sun.kind = LightKind::sun;
    EXPECT_LE(fitted_grid(fog, lamp, 1024).size.z, 8 * side);
    EXPECT_LE(fitted_grid(fog, sun, 1024).size.z, 8 * side);
    EXPECT_LE(fitted_grid(fog, sun, 1024).size.x, 12 * side);
}

// Fog whose bounds change a little keeps its corners: no shimmer from frame to frame.
TEST(LightGrid, StandsStillWhileBoundsChange) {
    const Medium small = medium_of(volume_of(ivec3(0), ivec3(77, 63, 70), exact_noise));
    const Medium large = medium_of(volume_of(ivec3(-1, 0, 1), ivec3(78, 64, 71), exact_noise));
    const Medium* const before[] = {&small};
    const Medium* const after[] = {&large};
    Light sun, spot, lamp;
    sun.kind = LightKind::sun, sun.direction = glm::normalize(vec3(0.4f, -1, 0.25f));
    spot.kind = LightKind::spot, spot.position = vec3(30, 190, 40), spot.outer_cone = 0.3f;
    lamp.position = vec3(30, 190, 40);
    for (const Light& light : {sun, spot, lamp}) {
        const LightDepthGrid a = fitted_grid(before, light, 32), b = fitted_grid(after, light, 32);
        EXPECT_EQ(a.scale.x, b.scale.x);
        EXPECT_EQ(a.scale.z, b.scale.z);
        EXPECT_EQ(a.position, b.position);
        for (const LightDepthGrid& grid : {a, b}) EXPECT_EQ(grid.offset, glm::round(grid.offset));
        EXPECT_EQ(a.world_to_grid, b.world_to_grid);
    }
}

// The octahedron's folds are where two coordinates change sign below the light, and its equator.
TEST(LightGrid, OctahedronHasNoSeams) {
    Snapshot snapshot;
    snapshot.media = {noise_fog()};
    Light light;
    light.position = vec3(side / 2);
    const LightDepth depth = make_light_depth(snapshot, light, LightTransmittance::grid, 24);
    ASSERT_EQ(depth.grid.projection, LightProjection::all_around);
    double largest = 0, largest_elsewhere = 0;
    for (uint32_t i = 0; i < 4000; ++i) {
        vec3 direction = random_direction(i, 8);
        if (i % 4 == 0) direction = vec3(0, direction.y, -std::abs(direction.z));
        if (i % 4 == 1) direction = vec3(direction.x, 0, -std::abs(direction.z));
        if (i % 4 == 2) direction.z = 0;
        const vec3 normal = i % 4 == 0 ? vec3(1, 0, 0) : i % 4 == 1 ? vec3(0, 1, 0) : vec3(0, 0, 1);
        float v[3][16], found[16];
        int32_t active[16] = {-1, -1};
        for (int lane = 0; lane < 2; ++lane) {
            const vec3 p = light.position + 40.0f * glm::normalize(direction) + (lane ? 2e-3f : -2e-3f) * normal;
            v[0][lane] = p.x, v[1][lane] = p.y, v[2][lane] = p.z;
        }
        light_depths(depth, v[0], v[1], v[2], active, found);
        double& worst = i % 4 == 3 ? largest_elsewhere : largest;
        worst = std::max(worst, std::abs(double{found[0]} - found[1]));
    }
    // As smooth across the folds as anywhere else.
    EXPECT_LT(largest, 2 * largest_elsewhere);
    EXPECT_LT(largest, 1e-3);
}

TEST(LightGrid, SameBitsAtAnyThreadCount) {
    Snapshot snapshot;
    snapshot.media = {noise_fog()};
    Light light;
    light.position = vec3(side / 2);
    const auto made = [&] { return make_light_depth(snapshot, light, LightTransmittance::grid, 24); };
    const LightDepth one = on_threads(1, made), three = on_threads(3, made);
    EXPECT_EQ(*one.grid.depth, *three.grid.depth);
}

TEST(LightGrid, ColumnsOnDemandHaveTheSameBits) {
    const Medium& fog = noise_fog();
    Light sun;
    sun.kind = LightKind::sun, sun.direction = glm::normalize(vec3(0.4f, -1, 0.2f));
    LightDepthGrid whole = fitted_grid(std::array{&fog}, sun, 40), asked = whole;
    fill_grid(std::array{&fog}, whole);
    const GridColumns columns({&fog}, asked);
    const int packets = columns.packets_across() * asked.size.y;
    const auto is_same = [&](int packet) {
        const int first = packet % columns.packets_across() * 16, row = packet / columns.packets_across();
        for (int k = 0; k < asked.size.z; ++k)
            for (int u = first; u < std::min(first + 16, asked.size.x); ++u)
                if (const int at = (k * asked.size.y + row) * asked.size.x + u;
                    asked.depth->at(static_cast<size_t>(at)) != whole.depth->at(static_cast<size_t>(at)))
                    return false;
        return true;
    };
    EXPECT_FALSE(is_same(packets / 2));
    for (int i = 0; i < packets; ++i) ASSERT_FALSE(columns.is_filled(i));
    parallel_for(4 * packets, [&](int64_t i) { columns.fill(static_cast<int>(i * 7 % packets)); }); // some often
    for (int i = 0; i < packets; ++i) ASSERT_EQ(is_same(i), columns.is_filled(i));
    for (int i = 0; i < packets; ++i) columns.fill(i);
    EXPECT_EQ(*asked.depth, *whole.depth);
}
}
}
