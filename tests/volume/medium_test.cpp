// Density and optical depth of every kind of medium against closed forms.
#include "base/simd/isa.h"
#include "volume/fog_fixtures.h"
#include "volume/medium_simd.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include <cstring>

namespace tyndall::test {
namespace {
using namespace HWY_NAMESPACE; // AVX2's kernels, as this file is compiled once

struct Points {
    alignas(64) float x[16], y[16], z[16];

    vec3 at(int lane) const { return {x[lane], y[lane], z[lane]}; }
    void set(int lane, vec3 p) { x[lane] = p.x, y[lane] = p.y, z[lane] = p.z; }
};

std::array<float, 16> densities_at(const Medium& medium, const Points& points) {
    std::array<float, 16> result;
    densities(medium, points.x, points.y, points.z, result.data());
    return result;
}

Points random_points(vec3 low, vec3 high, uint32_t packet) {
    Points points;
    for (int lane = 0; lane < 16; ++lane) points.set(lane, random_point(low, high, packet * 16 + lane, 5));
    return points;
}

// Leaves, constant bricks, tiles and holes under a general transform.
SparseVolume varied_volume() {
    SparseVolume volume = volume_of(ivec3(-20, 0, 0), ivec3(11, 23, 31), exact_noise);
    volume.tiles.push_back({ivec3(16, 0, 0), ivec3(47, 31, 31), 0.5f});
    volume.active_high = ivec3(47, 31, 31);
    volume.index_to_world = glm::scale(glm::rotate(dmat4(1), 0.4, glm::normalize(dvec3(1, 1, 0))), dvec3(0.5, 1, -0.7));
    volume.index_to_world[1][0] += 0.3;
    return volume;
}

std::vector<std::string_view> vector_isas() {
    std::vector<std::string_view> names;
    const std::string_view best = set_isa("auto");
    if (best == "avx512") names = {"avx512", "avx2"};
    if (best == "avx2") names = {"avx2"};
    return names;
}

TEST(Densities, EqualTheScalarSample) {
    const Medium medium = medium_of(varied_volume());
    const Box box = medium.density.bricks->bounds;
    const float tolerance = vector_isas().empty() ? 2e-5f : 0; // the same bits where multiply-adds fuse
    for (uint32_t packet = 0; packet < 1000; ++packet) {
        const Points points = random_points(box.low - 2.0f, box.high + 2.0f, packet);
        const auto density = densities_at(medium, points);
        for (int lane = 0; lane < 16; ++lane)
            EXPECT_NEAR(density[lane], sample_density(*medium.density.bricks, points.at(lane)), tolerance);
    }
}

TEST(Densities, SameBitsOnEveryVectorInstructionSet) {
    const std::vector<std::string_view> isas = vector_isas();
    if (isas.size() < 2) GTEST_SKIP() << "needs a machine with AVX-512";
    const Medium bricks = medium_of(varied_volume()), height = height_fog(1, 2, 3);
    const Medium box = placed(homogeneous_medium(1, {vec3(-1), vec3(1)}), glm::rotate(mat4(1), 0.5f, vec3(0, 1, 0)));
    for (const Medium* medium : {&bricks, &height, &box})
        for (uint32_t packet = 0; packet < 500; ++packet) {
            const Points points = random_points(vec3(-20), vec3(30), packet);
            set_isa("avx512");
            const auto wide = densities_at(*medium, points);
            set_isa("avx2");
            const auto narrow = densities_at(*medium, points);
            EXPECT_EQ(std::memcmp(wide.data(), narrow.data(), sizeof wide), 0);
        }
    set_isa("auto");
}

TEST(Densities, LargePoolsSampleTheSame) {
    const Medium medium = medium_of(varied_volume());
    for (uint32_t packet = 0; packet < 100; ++packet) {
        const Points points =
            random_points(medium.density.bricks->bounds.low, medium.density.bricks->bounds.high, packet);
        alignas(64) float far[16];
        store(brick_density_far(*medium.density.bricks, {load(points.x), load(points.y), load(points.z)}), far);
        const auto near = densities_at(medium, points);
        for (int lane = 0; lane < 16; ++lane) EXPECT_NEAR(far[lane], near[lane], 1e-6);
    }
}

TEST(Densities, PointsThatAreNowhere) {
    const float nan = std::nanf("");
    Points points = random_points(vec3(0), vec3(10), 0);
    for (const float bad : {infinity, -infinity, nan, 1e30f})
        for (int axis = 0; axis < 3; ++axis) {
            vec3 p(5);
            p[axis] = bad;
            points.set(axis, p);
            for (const Medium& medium : {medium_of(constant_box(11, 1)), homogeneous_medium(1, {vec3(0), vec3(10)})})
                EXPECT_EQ(densities_at(medium, points)[axis], 0) << bad;
        }
}

TEST(Densities, EmptyBricks) {
    const auto density = densities_at(medium_of(SparseVolume()), random_points(vec3(-1), vec3(1), 0));
    for (const float value : density) EXPECT_EQ(value, 0);
}

TEST(Densities, AnalyticMedia) {
    const Medium fog = height_fog(2, 1, 4, {vec3(-50, -3, -50), vec3(50)});
    const Medium box = placed(homogeneous_medium(2, {vec3(-1), vec3(1)}), glm::scale(mat4(1), vec3(3, 4, 5)));
    for (uint32_t packet = 0; packet < 100; ++packet) {
        const Points points = random_points(vec3(-10), vec3(20), packet);
        const auto height = densities_at(fog, points), inside = densities_at(box, points);
        for (int lane = 0; lane < 16; ++lane) {
            const vec3 p = points.at(lane);
            const float expected = p.y < -3 ? 0 : std::exp(-std::max(p.y - 1, 0.0f) / 4);
            EXPECT_NEAR(height[lane], expected, 1e-6);
            EXPECT_EQ(inside[lane], std::abs(p.x) <= 3 && std::abs(p.y) <= 4 && std::abs(p.z) <= 5 ? 1 : 0);
        }
    }
}

TEST(OpticalDepth, Homogeneous) {
    EXPECT_NEAR(optical_depth(homogeneous_medium(0.1f), Ray{vec3(3), vec3(0, 1, 0), 50}), 5, 1e-6);
    EXPECT_EQ(optical_depth(homogeneous_medium(0.1f), Ray{vec3(3), vec3(0, 1, 0)}), infinity);
    EXPECT_EQ(optical_depth(homogeneous_medium(0), Ray{vec3(3), vec3(0, 1, 0)}), 0);

    // A cube of 2 m seen along its diagonal, turned so that the diagonal is the z axis.
    const vec3 axis = glm::normalize(glm::cross(vec3(1), vec3(0, 0, 1)));
    const mat4 turned = glm::rotate(mat4(1), std::acos(1 / std::sqrt(3.0f)), axis);
    const Medium cube = placed(homogeneous_medium(2, {vec3(-1), vec3(1)}), turned);
    EXPECT_NEAR(optical_depth(cube, Ray{vec3(0, 0, 9), vec3(0, 0, -1)}), 4 * std::sqrt(3.0), 1e-5);
    EXPECT_NEAR(optical_depth(cube, Ray{vec3(0), vec3(0, 0, -1)}), 2 * std::sqrt(3.0), 1e-5);
    EXPECT_EQ(optical_depth(cube, Ray{vec3(0, 0, 9), vec3(0, 0, 1)}), 0);
}

TEST(OpticalDepth, HeightFogClosedForm) {
    const Ray ray{vec3(0), glm::normalize(vec3(std::sqrt(3.0f), 1, 0)), 40};
    const double tau = optical_depth(height_fog(0.1f, 0, 10), ray);
    EXPECT_NEAR(tau, 1.729329434, 1e-6);
    EXPECT_NEAR(std::exp(-tau), 0.177403331, 1e-6);
}

double height_depth_by_quadrature(const Medium& fog, const Ray& ray) {
    constexpr int pieces = 200000;
    double sum = 0;
    for (int i = 0; i < pieces; ++i) {
        const double t = (i + 0.5) * ray.t_max / pieces, y = ray.origin.y + t * ray.direction.y;
        sum += std::exp(-std::max(y - fog.density.height_base, 0.0) / fog.density.height_falloff);
    }
    return gray_extinction(fog.optics) * sum * ray.t_max / pieces;
}

TEST(OpticalDepth, HeightFogFromAnywhereToAnywhere) {
    const Medium fog = height_fog(0.3f, 2, 1.5f);
    const vec3 ends[][2] = {{{0, 5, 0}, {9, -4, 2}},  {{0, -4, 0}, {3, 8, 1}},        {{0, 3, 0}, {50, 3, 0}},
                            {{0, 1, 0}, {9, -20, 0}}, {{0, 3, 0}, {10, 3.00001f, 0}}, {{0, 30, 0}, {1, 2.5f, 1}}};
    for (const auto& [from, to] : ends) {
        const Ray ray = ray_between(from, to);
        EXPECT_NEAR(optical_depth(fog, ray) / height_depth_by_quadrature(fog, ray), 1, 1e-6) << from.y << ' ' << to.y;
    }
}

TEST(OpticalDepth, HeightFogWithoutEnd) {
    const Medium fog = height_fog(0.1f, 0, 10);
    EXPECT_NEAR(optical_depth(fog, Ray{vec3(0), vec3(0, 1, 0)}), 1, 1e-6);
    EXPECT_NEAR(optical_depth(fog, Ray{vec3(0, -20, 0), vec3(0, 1, 0)}), 3, 1e-6);
    EXPECT_EQ(optical_depth(fog, Ray{vec3(0, 5, 0), vec3(0, -1, 0)}), infinity);
    EXPECT_EQ(optical_depth(fog, Ray{vec3(0, 5, 0), vec3(1, 0, 0)}), infinity);
    EXPECT_EQ(optical_depth(fog, Ray{vec3(0, 1e9f, 0), vec3(1, 0, 0)}), 0);
    EXPECT_NEAR(optical_depth(fog, Ray{vec3(0, 1e9f, 0), vec3(0, -1, 0), 9e8f}), 0, 1e-12);
    const Medium layer = height_fog(0.1f, 0, 10, {vec3(-100, 0, -100), vec3(100, 20, 100)});
    EXPECT_NEAR(optical_depth(layer, Ray{vec3(0, 50, 0), vec3(0, -1, 0)}), 1 - std::exp(-2.0), 1e-6);
}

// Voxels are worth half outside the box of their centers: 64 of them make a box from -½ to 63½.
const Box box64{vec3(-0.5f), vec3(63.5f)};

TEST(OpticalDepth, ConstantBoxEqualsHomogeneousBox) {
    const Medium bricks = medium_of(constant_box(64, 1), 0.05f), box = homogeneous_medium(0.05f, box64);
    for (uint32_t i = 0; i < 1000; ++i) {
        // From face to face, away from the rounded edges.
        vec3 from = random_point(vec3(2), vec3(61), i, 0), to = random_point(vec3(2), vec3(61), i, 1);
        from[i % 3] = -40, to[i % 3] = 100;
        const vec3 way = glm::normalize(to - from);
        const float entry = (0.0f - from[i % 3]) / way[i % 3], exit = (63.0f - from[i % 3]) / way[i % 3];
        const vec3 a = from + entry * way, b = from + exit * way;
        bool clear = true;
        for (int axis = 0; axis < 3; ++axis)
            clear &= axis == int(i % 3) || (std::min(a[axis], b[axis]) > 3 && std::max(a[axis], b[axis]) < 60);
        if (!clear) continue;
        const Ray ray{from, way};
        EXPECT_NEAR(optical_depth(bricks, ray) / optical_depth(box, ray), 1, 1e-6);
    }
}

TEST(OpticalDepth, SameUnderAnyAffineTransform) {
    dmat4 shear(1);
    shear[1][0] = 0.8, shear[2][0] = -0.4, shear[0][2] = 0.3;
    const dmat4 turn = glm::rotate(glm::translate(dmat4(1), dvec3(7, -3, 2)), 1.1, glm::normalize(dvec3(1, -2, 0.5)));
    const dmat4 matrices[] = {dmat4(1), glm::scale(dmat4(1), dvec3(1, 2, 5)),
                              shear,    glm::scale(dmat4(1), dvec3(-1, 1, 1)),
                              turn,     turn * shear * glm::scale(dmat4(1), dvec3(1, 2, -5))};
    for (const dmat4& matrix : matrices) {
        SparseVolume volume = constant_box(64, 1);
        volume.index_to_world = matrix;
        const Medium bricks = medium_of(volume, 0.05f), box = placed(homogeneous_medium(0.05f, box64), mat4(matrix));
        for (uint32_t i = 0; i < 200; ++i) {
            vec3 from = random_point(vec3(20), vec3(44), i, 0), to = random_point(vec3(20), vec3(44), i, 1);
            from[i % 3] = -20, to[i % 3] = 90;
            const Ray ray = ray_between(vec3(matrix * glm::dvec4(from, 1)), vec3(matrix * glm::dvec4(to, 1)));
            EXPECT_NEAR(optical_depth(bricks, ray) / optical_depth(box, ray), 1, 1e-4);
        }
    }
}

TEST(OpticalDepth, SingleVoxelIsAHat) {
    const Medium voxel = medium_of(volume_of(ivec3(5), ivec3(5), [](int, int, int) { return 1.0f; }));
    EXPECT_NEAR(optical_depth(voxel, Ray{vec3(-3, 5, 5), vec3(1, 0, 0)}), 1, 1e-6);
    EXPECT_NEAR(optical_depth(voxel, Ray{vec3(5.25f, 4.5f, 20), vec3(0, 0, -1)}), 0.75 * 0.5, 1e-6);
    const Ray diagonal{vec3(0), glm::normalize(vec3(1)), 100};
    EXPECT_NEAR(optical_depth(voxel, diagonal), std::sqrt(3.0) / 2, 1e-6);
    EXPECT_NEAR(optical_depth(voxel, Ray{vec3(5), vec3(0, 1, 0)}), 0.5, 1e-6);
}

TEST(OpticalDepth, TrilinearDensityIsExact) {
    const SparseVolume volume = volume_of(ivec3(-9, -2, 0), ivec3(20, 17, 15), exact_noise);
    const Medium medium = medium_of(volume);
    const VoxelMap map(volume);
    for (uint32_t i = 0; i < 20; ++i) {
        const Ray ray = ray_between(random_point(vec3(-30), vec3(-5), i, 0), random_point(vec3(15), vec3(40), i, 1));
        constexpr int pieces = 20000;
        double sum = 0;
        for (int k = 0; k < pieces; ++k) {
            const double t = (k + 0.5) * ray.t_max / pieces;
            sum += map.sample(dvec3(ray.origin) + t * dvec3(ray.direction)) * ray.t_max / pieces;
        }
        EXPECT_NEAR(optical_depth(medium, ray), sum, 1e-5 * sum + 1e-5);
    }
}

TEST(OpticalDepth, TwoHalvesEqualOne) {
    const SparseVolume whole = volume_of(ivec3(0), ivec3(31), exact_noise);
    const SparseVolume half =
        volume_of(ivec3(0), ivec3(31), [](int x, int y, int z) { return exact_noise(x, y, z) / 2; });
    const std::vector<Medium> two{medium_of(half), medium_of(half)}, one{medium_of(whole)};
    const std::vector<Medium> mixed{medium_of(half), homogeneous_medium(0.25f), medium_of(half),
                                    homogeneous_medium(0.75f)};
    for (uint32_t i = 0; i < 100; ++i) {
        const Ray ray = ray_between(random_point(vec3(-9), vec3(9), i, 0), random_point(vec3(9), vec3(40), i, 1));
        const double depth = optical_depth(one, ray);
        EXPECT_NEAR(optical_depth(two, ray), depth, 1e-6);
        EXPECT_NEAR(optical_depth(mixed, ray), depth + ray.t_max, 1e-4);
    }
}

TEST(OpticalDepth, TilesEqualLeaves) {
    SparseVolume tiles;
    tiles.active_low = ivec3(3, 0, -8), tiles.active_high = ivec3(40, 23, 20);
    tiles.tiles.push_back({tiles.active_low, tiles.active_high, 0.37f});
    const Medium a = medium_of(tiles);
    const Medium b = medium_of(volume_of(tiles.active_low, tiles.active_high, [](int, int, int) { return 0.37f; }));
    for (uint32_t i = 0; i < 200; ++i) {
        const Ray ray = ray_between(random_point(vec3(-20), vec3(50), i, 0), random_point(vec3(-20), vec3(50), i, 1));
        EXPECT_NEAR(optical_depth(a, ray), optical_depth(b, ray), 1e-6);
    }
}

TEST(OpticalDepth, ScalesWithTheScene) {
    const Ray unit = ray_between(vec3(-10, 3, 4), vec3(40, 20, 30));
    SparseVolume volume = volume_of(ivec3(0), ivec3(31), exact_noise);
    const double depth = optical_depth(medium_of(volume, 0.1f), unit);
    for (const float scale : {1e-3f, 1e-2f, 0.37f, 10.0f, 1e3f}) {
        volume.index_to_world = glm::scale(dmat4(1), dvec3(scale));
        const Ray ray{unit.origin * scale, unit.direction, unit.t_max * scale};
        EXPECT_NEAR(optical_depth(medium_of(volume, 0.1f / scale), ray) / depth, 1, 1e-5) << scale;
    }
}

TEST(OpticalDepth, SameFarFromTheOrigin) {
    const Ray ray{vec3(-10, 3, 4), glm::normalize(vec3(4, 1, 2)), 100};
    SparseVolume volume = volume_of(ivec3(0), ivec3(31), exact_noise);
    const double depth = optical_depth(medium_of(volume), ray);
    const vec3 far(1e6f, -2e6f, 1e6f);
    volume.index_to_world = glm::translate(dmat4(1), dvec3(far));
    EXPECT_NEAR(optical_depth(medium_of(volume), {ray.origin + far, ray.direction, ray.t_max}) / depth, 1, 1e-6);

    // The same through the voxels' own coordinates.
    volume = volume_of(ivec3(1 << 20), ivec3((1 << 20) + 31),
                       [](int x, int y, int z) { return exact_noise(x & 31, y & 31, z & 31); });
    volume.index_to_world = glm::translate(dmat4(1), dvec3(-(1 << 20)));
    EXPECT_NEAR(optical_depth(medium_of(volume), ray) / depth, 1, 1e-6);
}

TEST(OpticalDepth, AxisParallelRaysAreNeverNaN) {
    const Medium media[] = {medium_of(volume_of(ivec3(0), ivec3(23), exact_noise)),
                            homogeneous_medium(1, {vec3(0), vec3(23)}), height_fog(1, 4, 3, {vec3(0), vec3(23)})};
    for (uint32_t i = 0; i < 100000; ++i) {
        // Grid planes, brick faces, bounds and their neighbors are the places to go wrong.
        vec3 origin = glm::round(random_point(vec3(-2), vec3(26), i, 0));
        if (i % 3 == 0) origin[i / 3 % 3] = std::nextafter(origin[i / 3 % 3], i % 2 ? 100.0f : -100.0f);
        vec3 direction(i % 2 ? 0.0f : -0.0f);
        direction[i % 3] = i / 3 % 2 ? 1.0f : -1.0f;
        for (const Medium& medium : media) {
            const double depth = optical_depth(medium, Ray{origin, direction});
            ASSERT_TRUE(depth >= 0 && depth < 60) << origin.x << ' ' << origin.y << ' ' << origin.z << ' ' << i % 3;
        }
    }
}

TEST(OpticalDepth, EmptyAndThinGrids) {
    EXPECT_EQ(optical_depth(medium_of(SparseVolume()), Ray{}), 0);
    const Medium sheet = medium_of(volume_of(ivec3(0, 4, 0), ivec3(30, 4, 30), [](int, int, int) { return 0.5f; }));
    EXPECT_NEAR(optical_depth(sheet, Ray{vec3(15, 20, 15), vec3(0, -1, 0)}), 0.5, 1e-6);
    EXPECT_NEAR(optical_depth(sheet, Ray{vec3(15, 20, 15), glm::normalize(vec3(0.1f, -1, 0))}), 0.5 * std::sqrt(1.01),
                1e-6);
}
}
}
