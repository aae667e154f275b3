// Bricks hold exactly what leaves and tiles say.
#include "base/error.h"
#include "support/expect.h"
#include "support/threads.h"
#include "volume/bricks/half.h"
#include "volume/fog_fixtures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

namespace tyndall::test {
namespace {
// Leaves and tiles on both sides of the origin: noise, a constant leaf, an aligned tile, one that is not.
SparseVolume mixed_volume() {
    SparseVolume volume = volume_of(ivec3(-21, -8, -3), ivec3(5, 13, 20), exact_noise);
    volume.leaves.push_back({ivec3(8, 0, 0), {}});
    volume.leaves.back().values.fill(0.75f);
    volume.tiles.push_back({ivec3(24, 0, 0), ivec3(55, 31, 31), 0.5f});
    volume.tiles.push_back({ivec3(24, 35, 3), ivec3(40, 47, 18), 0.25f});
    volume.active_high = ivec3(55, 47, 31);
    return volume;
}

bool same_bricks(const BrickPool& a, const BrickPool& b) {
    return a.low == b.low && a.size == b.size && a.index == b.index && a.values == b.values &&
           a.constants == b.constants && a.minimum == b.minimum && a.maximum == b.maximum;
}

bool same(const BrickPool& a, const BrickPool& b) { return same_bricks(a, b) && a.mass == b.mass && a.mean == b.mean; }

TEST(Half, EveryHalfSurvives) {
    for (uint32_t half = 0; half <= 0x7bff; ++half) EXPECT_EQ(half_from_float(float_from_half(half)), half);
    EXPECT_EQ(float_from_half(1), 0x1p-24f);
    EXPECT_EQ(float_from_half(0x3c00), 1.0f);
    EXPECT_EQ(float_from_half(0x7bff), 65504.0f);
}

TEST(Half, RoundsToNearestTiesToEven) {
    for (uint32_t half = 0; half < 0x7bff; ++half) {
        const float low = float_from_half(half), high = float_from_half(half + 1), middle = low + (high - low) / 2;
        const uint32_t even = half + (half & 1);
        EXPECT_EQ(half_from_float(middle), even);
        EXPECT_EQ(half_from_float(std::nextafter(middle, 0.0f)), half);
        EXPECT_EQ(half_from_float(std::nextafter(middle, 1e6f)), half + 1);
    }
}

TEST(Half, ClampsWhatDoesNotFit) {
    EXPECT_EQ(half_from_float(1e9f), 0x7bff);
    EXPECT_EQ(half_from_float(infinity), 0x7bff);
    EXPECT_EQ(half_from_float(-1.0f), 0);
    EXPECT_EQ(half_from_float(std::nanf("")), 0);
}

TEST(Half, ManyAtOnceEqualOneByOne) {
    std::vector<float> floats{-1,    infinity, -infinity, std::nanf(""), 1e9f,
                              65519, 65520,    0x1p-25f,  0x1.002p-25f,  6e-5f};
    for (uint32_t i = 0; i < 1000; ++i) floats.push_back(std::exp2(random_in(-27, 17, i, 0)));
    for (size_t count : {size_t(0), size_t(1), size_t(7), size_t(100), floats.size()}) {
        std::vector<uint16_t> halves(count + 1, 0xffff);
        const HalfRange range = halves_from_floats(floats.data(), count, halves.data());
        for (size_t i = 0; i < count; ++i) EXPECT_EQ(halves[i], half_from_float(floats[i])) << floats[i];
        EXPECT_EQ(halves[count], 0xffff);
        if (count == 0) continue;
        EXPECT_EQ(range.low, *std::min_element(halves.begin(), halves.end() - 1));
        EXPECT_EQ(range.high, *std::max_element(halves.begin(), halves.end() - 1));
    }
}

TEST(Bricks, SampleIsTrilinearBetweenVoxels) {
    const SparseVolume volume = mixed_volume();
    const auto pool = make_bricks(volume);
    const VoxelMap map(volume);
    for (uint32_t i = 0; i < 20000; ++i) {
        const vec3 point = random_point(vec3(-25, -12, -7), vec3(60, 52, 36), i, 0);
        EXPECT_NEAR(sample_density(*pool, point), map.sample(point), 2e-5) << i;
    }
}

TEST(Bricks, SampleAtVoxelCentersIsExact) {
    const SparseVolume volume = mixed_volume();
    const auto pool = make_bricks(volume);
    const VoxelMap map(volume);
    for (int x = -23; x < 58; x += 3)
        for (int y = -10; y < 50; ++y)
            for (int z = -5; z < 34; ++z)
                EXPECT_EQ(sample_density(*pool, vec3(x, y, z)), map.at(ivec3(x, y, z))) << x << ' ' << y << ' ' << z;
}

TEST(Bricks, NothingOutside) {
    const auto pool = make_bricks(constant_box(16, 1));
    for (const vec3 point : {vec3(-1, 8, 8), vec3(16, 8, 8), vec3(-1e9f, 8, 8), vec3(8, 1e30f, 8), vec3(8, 8, infinity),
                             vec3(8, 8, -infinity), vec3(std::nanf(""), 8, 8)})
        EXPECT_EQ(sample_density(*pool, point), 0) << point.x << ' ' << point.y << ' ' << point.z;
    EXPECT_FLOAT_EQ(sample_density(*pool, vec3(-0.5f, 8, 8)), 0.5f);
    EXPECT_FLOAT_EQ(sample_density(*pool, vec3(8, 15.75f, 8)), 0.25f);
}

TEST(Bricks, LinearRampHasNoSeamsAtLeafFaces) {
    const auto ramp = [](int x, int y, int z) { return static_cast<float>(x + 2 * y + 3 * z) / 256; };
    const auto pool = make_bricks(volume_of(ivec3(0), ivec3(39), ramp));
    for (uint32_t i = 0; i < 20000; ++i) {
        vec3 point = random_point(vec3(0), vec3(39), i, 0);
        if (i % 2) point[i % 3] = std::nextafter(std::round(point[i % 3] / 8) * 8, i % 4 < 2 ? 0.0f : 100.0f);
        point = glm::clamp(point, vec3(0), vec3(39));
        EXPECT_NEAR(sample_density(*pool, point), (point.x + 2 * point.y + 3 * point.z) / 256, 1e-5);
    }
}

TEST(Bricks, ALeafComesBeforeTheTileAroundIt) {
    SparseVolume volume = constant_box(8, 0.25f);
    volume.active_high = ivec3(15);
    volume.tiles = {{ivec3(0), ivec3(15), 1}};
    const auto pool = make_bricks(volume);
    EXPECT_EQ(sample_density(*pool, vec3(3)), 0.25f);
    EXPECT_EQ(sample_density(*pool, vec3(12)), 1);
}

TEST(Bricks, MinimumAndMaximumAreThoseOfTheCornerValues) {
    const SparseVolume volume = mixed_volume();
    const auto pool = make_bricks(volume);
    const VoxelMap map(volume);
    size_t cell = 0;
    float highest = 0;
    for (int x = 0; x < pool->size.x; ++x)
        for (int y = 0; y < pool->size.y; ++y)
            for (int z = 0; z < pool->size.z; ++z, ++cell) {
                float least = infinity, largest = 0;
                for (int c = 0; c < 729; ++c) {
                    const float value = map.at(pool->low + ivec3(x, y, z) * 8 + ivec3(c / 81, c / 9 % 9, c % 9));
                    least = std::min(least, value), largest = std::max(largest, value);
                }
                EXPECT_EQ(pool->minimum[cell], least);
                EXPECT_EQ(pool->maximum[cell], largest);
                EXPECT_EQ(pool->index[cell] == 0, largest == 0);
                highest = std::max(highest, largest);
            }
    EXPECT_EQ(pool->highest, highest);
}

TEST(Bricks, TilesEqualLeaves) {
    SparseVolume tiles;
    tiles.active_low = ivec3(-8), tiles.active_high = ivec3(39);
    tiles.tiles.push_back({ivec3(-8, -8, -8), ivec3(39, 39, 15), 0.3f});
    tiles.tiles.push_back({ivec3(-8, -8, 16), ivec3(39, 39, 39), 0.7f});
    const auto dense =
        make_bricks(volume_of(ivec3(-8), ivec3(39), [](int, int, int z) { return z < 16 ? 0.3f : 0.7f; }));
    const auto pool = make_bricks(tiles);
    EXPECT_TRUE(same_bricks(*pool, *dense));
    EXPECT_NEAR(pool->mass / dense->mass, 1, 1e-6);
}

TEST(Bricks, TileThatIsNotAlignedEqualsLeaves) {
    SparseVolume tile;
    tile.active_low = ivec3(-5, 3, 0), tile.active_high = ivec3(20, 30, 7);
    tile.tiles.push_back({tile.active_low, tile.active_high, 0.5f});
    const auto dense = make_bricks(volume_of(ivec3(-5, 3, 0), ivec3(20, 30, 7), [](int, int, int) { return 0.5f; }));
    EXPECT_TRUE(same(*make_bricks(tile), *dense));
}

TEST(Bricks, InsideOfATileTakesNoVoxels) {
    SparseVolume volume;
    volume.active_high = ivec3(511);
    volume.tiles.push_back({ivec3(0), ivec3(511), 0.5f});
    const auto pool = make_bricks(volume);
    const auto dense = std::count_if(pool->index.begin(), pool->index.end(), [](int32_t id) { return id > 0; });
    EXPECT_EQ(dense, 65 * 65 * 65 - 63 * 63 * 63); // the surface
    EXPECT_EQ(pool->values.size(), size_t(dense) * brick_stride);
    EXPECT_EQ(pool->constants, std::vector<float>{0.5f});
}

TEST(Bricks, ConstantLeavesBecomeConstants) {
    const auto pool = make_bricks(constant_box(64, 0.25f));
    EXPECT_EQ(std::count_if(pool->index.begin(), pool->index.end(), [](int32_t id) { return id < 0; }), 7 * 7 * 7);
    EXPECT_EQ(pool->constants, std::vector<float>{0.25f});
    EXPECT_EQ(pool->values.size(), size_t(9 * 9 * 9 - 7 * 7 * 7) * brick_stride);
}

TEST(Bricks, MassMeanAndBounds) {
    SparseVolume volume = mixed_volume();
    const VoxelMap map(volume);
    volume.index_to_world = glm::scale(glm::translate(dmat4(1), dvec3(3, 4, 5)), dvec3(0.5, 2, -1));
    const auto pool = make_bricks(volume);
    EXPECT_NEAR(pool->mass, map.sum(), 1e-6 * map.sum());
    const vec3 extent = pool->bounds.size();
    EXPECT_NEAR(double(pool->mean) * extent.x * extent.y * extent.z, map.sum(), 1e-5 * map.sum());
    const auto filled = std::count_if(pool->index.begin(), pool->index.end(), [](int32_t id) { return id != 0; });
    EXPECT_NEAR(double(pool->mean_in_bricks) * 512 * filled, map.sum(), 1e-5 * map.sum());

    // One voxel of fall-off around the first and the last voxel that is not 0.
    EXPECT_NEAR(pool->bounds.low.x, 3 - 0.5 * 22, 1e-4);
    EXPECT_NEAR(pool->bounds.high.x, 3 + 0.5 * 56, 1e-4);
    EXPECT_NEAR(pool->bounds.low.z, 5 - 32, 1e-4);
    EXPECT_NEAR(pool->bounds.high.z, 5 + 4, 1e-4);
    EXPECT_EQ(pool->voxel_size, vec3(0.5f, 2, 1));
}

TEST(Bricks, EmptyVolumes) {
    SparseVolume zeros = constant_box(8, 0), tiny = constant_box(8, 1e-9f), none;
    for (const SparseVolume* volume : {&zeros, &tiny, &none}) {
        const auto pool = make_bricks(*volume);
        EXPECT_TRUE(pool->empty());
        EXPECT_TRUE(pool->bounds.empty());
        EXPECT_EQ(pool->highest, 0);
        EXPECT_EQ(pool->bytes(), 0u);
        EXPECT_EQ(sample_density(*pool, vec3(1)), 0);
    }
}

TEST(Bricks, ThinGridAndSingleVoxel) {
    const auto sheet = make_bricks(volume_of(ivec3(0, 7, 0), ivec3(30, 7, 30), exact_noise));
    EXPECT_EQ(sample_density(*sheet, vec3(9, 7, 11)), exact_noise(9, 7, 11));
    EXPECT_EQ(sample_density(*sheet, vec3(9, 8, 11)), 0);
    const auto voxel = make_bricks(volume_of(ivec3(-1), ivec3(-1), [](int, int, int) { return 1.0f; }));
    EXPECT_FLOAT_EQ(sample_density(*voxel, vec3(-0.5f, -1.25f, -1)), 0.5f * 0.75f);
}

TEST(Bricks, TransformsOfAnyKind) {
    SparseVolume volume = mixed_volume();
    const VoxelMap map(volume);
    dmat4 shear(1);
    shear[1][0] = 0.7, shear[2][1] = -0.3;
    const dmat4 turned = glm::rotate(dmat4(1), 0.6, glm::normalize(dvec3(1, 2, 3)));
    for (const dmat4& matrix : {turned * shear, glm::scale(turned, dvec3(-1, 2, 0.1)), shear * turned * shear}) {
        volume.index_to_world = matrix;
        const auto pool = make_bricks(volume);
        for (uint32_t i = 0; i < 2000; ++i) {
            const vec3 index = random_point(vec3(-25, -12, -7), vec3(60, 52, 36), i, 0);
            const vec3 world(matrix * glm::dvec4(index, 1));
            const dvec3 exact(glm::inverse(matrix) * glm::dvec4(world, 1));
            EXPECT_NEAR(sample_density(*pool, world), map.sample(exact), 1e-4);
        }
    }
}

TEST(Bricks, FarFromTheOrigin) {
    SparseVolume volume = mixed_volume();
    const auto near = make_bricks(volume);
    volume.index_to_world = glm::translate(dmat4(1), dvec3(1e6, -1e6, 1e6));
    const auto far = make_bricks(volume);
    for (uint32_t i = 0; i < 5000; ++i) {
        const vec3 point = glm::round(16.0f * random_point(vec3(-25, -12, -7), vec3(60, 52, 36), i, 0)) / 16.0f;
        EXPECT_NEAR(sample_density(*far, point + vec3(1e6f, -1e6f, 1e6f)), sample_density(*near, point), 1e-5);
    }
}

TEST(Bricks, PlaceMovesTheFog) {
    SparseVolume volume = mixed_volume();
    BrickPool moved = *make_bricks(volume);
    volume.index_to_world = glm::rotate(glm::translate(dmat4(1), dvec3(1, 2, 3)), 0.3, dvec3(0, 1, 0));
    place(moved, volume.index_to_world);
    const auto made = make_bricks(volume);
    EXPECT_TRUE(same(moved, *made));
    EXPECT_EQ(moved.bounds.low, made->bounds.low);
    EXPECT_EQ(moved.world_to_index, made->world_to_index);
    EXPECT_EQ(moved.anchor_index, made->anchor_index);
}

TEST(Bricks, SameBitsOnAnyNumberOfThreads) {
    const SparseVolume volume = mixed_volume();
    const auto made = [&] { return make_bricks(volume); };
    EXPECT_TRUE(same(*on_threads(1, made), *on_threads(3, made)));
}

ExitCode code_of(const SparseVolume& volume) {
    return error_of([&] { make_bricks(volume); }).code;
}

TEST(Bricks, RefusesWhatDoesNotFit) {
    SparseVolume scattered; // two voxels 8000 voxels apart
    scattered.leaves.push_back({ivec3(0), {}});
    scattered.leaves.push_back({ivec3(8000), {}});
    for (Leaf& leaf : scattered.leaves) leaf.values.fill(1);
    EXPECT_EQ(code_of(scattered), ExitCode::out_of_memory);
    EXPECT_THAT(bricks_problem(scattered), ::testing::HasSubstr("stray voxels"));

    SparseVolume huge;
    huge.tiles.push_back({ivec3(0), ivec3(4095), 1});
    EXPECT_EQ(code_of(huge), ExitCode::out_of_memory);
    EXPECT_EQ(bricks_problem(huge), "spans 4096x4096x4096 voxels, too many to store: use larger voxels");
    EXPECT_EQ(bricks_problem(constant_box(8, 1)), "");

    SparseVolume far = constant_box(8, 1);
    far.leaves[0].origin.x = std::numeric_limits<int>::max() - 7;
    EXPECT_EQ(code_of(far), ExitCode::refused);

    SparseVolume flat = constant_box(8, 1);
    flat.index_to_world = glm::scale(dmat4(1), dvec3(1, 0, 1));
    EXPECT_EQ(code_of(flat), ExitCode::refused);
    flat.index_to_world = glm::scale(dmat4(1), dvec3(1e60));
    EXPECT_EQ(code_of(flat), ExitCode::refused);
}
}
}
