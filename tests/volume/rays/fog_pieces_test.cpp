// Fog along rays in closed form, against the samplers and the columns of optical_depth().
#include "volume/rays/fog_pieces.h"

#include "volume/fog_fixtures.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
// optical_depth() keeps what is inside the cells of a grid in float: some ten roundings of values up to the densest,
// over the whole length at most.
double rounding(const Medium& grid, const Ray& ray) {
    return 10 * 0x1p-24 * double{grid.majorant()} * double{ray.t_max};
}

TEST(FogPieces, HeightFogIsItsFormula) {
    const Medium fog = height_fog(0.1f, 1, 2);
    const Ray ray{{0, -1, 0}, glm::normalize(vec3(1, 1, 0)), 12};
    FogPieces pieces;
    find_fog(ray, {&fog, 1}, 0, pieces);
    ASSERT_EQ(pieces.pieces.size(), 2u); // below the base and above it
    const double rise = double(ray.direction.y), base = 2 / rise;
    EXPECT_NEAR(pieces.pieces[1].low, base, 1e-9);
    EXPECT_NEAR(pieces.density(0, 0, 1), 1, 1e-15);
    for (const double t : {3.0, 5.0, 11.0}) {
        EXPECT_NEAR(pieces.density(1, 0, t), std::exp(-(rise * t - 2) / 2), 1e-12);
        const double column = base + (1 - std::exp(-(rise * t - 2) / 2)) * 2 / rise;
        EXPECT_NEAR(pieces.depth_at(1, t), double(0.1f) * column, 1e-12);
    }
    EXPECT_NEAR(pieces.depth, optical_depth(fog, ray), 1e-12);
}

TEST(FogPieces, SteepAndLevelHeightFogStaysFinite) {
    const Medium fog = height_fog(0.1f, 0, 0.01f);
    for (const vec3 direction : {vec3(0, -1, 0), vec3(0, 1, 0), vec3(1, 0, 0), glm::normalize(vec3(1, 1e-7f, 0))})
        for (const float height : {-5.0f, 0.0f, 0.02f, 50.0f}) {
            const Ray ray{{0, height, 0}, direction, 60};
            FogPieces pieces;
            find_fog(ray, {&fog, 1}, 0, pieces);
            EXPECT_NEAR(pieces.depth, optical_depth(fog, ray), 1e-9 * (1 + pieces.depth));
        }
}

TEST(FogPieces, LeavesOutWhatNobodySees) {
    Medium fog = homogeneous_medium(1);
    FogPieces pieces;
    find_fog({{0, 0, 0}, {1, 0, 0}, 1e9f}, {&fog, 1}, 0, pieces);
    EXPECT_NEAR(pieces.depth, 64, 1e-9);
    fog.optics.extinction = vec3(1e-14f);
    find_fog({{0, 0, 0}, {1, 0, 0}}, {&fog, 1}, 0, pieces);
    EXPECT_NEAR(pieces.depth, 1e-2, 1e-8); // 1e12 m
    fog.optics.extinction = vec3(0);
    find_fog({{0, 0, 0}, {1, 0, 0}, 9}, {&fog, 1}, 0, pieces);
    EXPECT_TRUE(pieces.pieces.empty());
}

TEST(FogPieces, GridDensityIsTrilinearEverywhere) {
    const SparseVolume volume = volume_of(ivec3(-3), ivec3(14), exact_noise);
    const VoxelMap voxels(volume);
    const Medium fog = medium_of(volume, 0.7f);
    for (uint32_t i = 0; i < 200; ++i) {
        const Ray ray = ray_between(random_point(vec3(-6), vec3(17), i, 1), random_point(vec3(-6), vec3(17), i, 2));
        FogPieces pieces;
        find_fog(ray, {&fog, 1}, 0, pieces);
        EXPECT_NEAR(pieces.depth, optical_depth(fog, ray), rounding(fog, ray));
        for (size_t p = 0; p < pieces.pieces.size(); ++p) {
            const auto [low, high, depth, rate] = pieces.pieces[p];
            EXPECT_NEAR(rate, 1, 1e-6); // voxels of a meter
            for (const double share : {0.1, 0.5, 0.9}) {
                const double t = low + share * (high - low);
                const dvec3 point = dvec3(ray.origin) + t * dvec3(ray.direction);
                EXPECT_NEAR(pieces.density(p, 0, t), voxels.sample(point), 1e-11);
            }
            EXPECT_NEAR(pieces.depth_at(p, low), depth, 1e-12);
        }
    }
}

TEST(FogPieces, MediaLieOverEachOther) {
    // A grid, a tilted box and height fog: at every point the extinctions add up, and so do the depths.
    const Medium media[] = {
        medium_of(volume_of(ivec3(0), ivec3(11), exact_noise), 0.4f),
        placed(homogeneous_medium(0.3f, {vec3(2), vec3(9)}), glm::rotate(mat4(1), 0.4f, glm::normalize(vec3(1, 2, 3)))),
        height_fog(0.2f, 4, 3, {vec3(-2), vec3(20, 9, 20)}), homogeneous_medium(0)};
    for (uint32_t i = 0; i < 200; ++i) {
        const Ray ray = ray_between(random_point(vec3(-4), vec3(16), i, 3), random_point(vec3(-4), vec3(16), i, 4));
        FogPieces pieces;
        find_fog(ray, media, 0, pieces);
        EXPECT_NEAR(pieces.depth, optical_depth(media, ray), rounding(media[0], ray));
        double end = 0;
        for (size_t p = 0; p < pieces.pieces.size(); ++p) {
            const FogPieces::Piece& piece = pieces.pieces[p];
            EXPECT_GE(piece.low, end);
            EXPECT_LT(piece.low, piece.high);
            end = piece.high;
            const Ray to_middle{ray.origin, ray.direction, static_cast<float>(0.5 * (piece.low + piece.high))};
            if (!(to_middle.t_max > piece.low && to_middle.t_max < piece.high)) continue; // no float between
            EXPECT_NEAR(pieces.depth_at(p, to_middle.t_max), optical_depth(media, to_middle),
                        rounding(media[0], to_middle));
            for (size_t m = 0; m < std::size(media); ++m) {
                float x[16], y[16], z[16], density[16];
                const vec3 point = to_middle.at(to_middle.t_max);
                std::fill(x, x + 16, point.x), std::fill(y, y + 16, point.y), std::fill(z, z + 16, point.z);
                densities(media[m], x, y, z, density);
                const double expected = gray_extinction(media[m].optics) > 0 ? density[0] : 0;
                if (piece.high - piece.low > 1e-4) { // else the float point may lie beside the piece
                    EXPECT_NEAR(pieces.density(p, m, to_middle.t_max), expected, 3e-5) << i << ' ' << m;
                }
            }
        }
    }
}

TEST(FogPieces, EndWhereTooLittlePasses) {
    const Medium fog = medium_of(constant_box(40, 1), 1); // pieces of 8 m
    FogPieces pieces;
    find_fog({{-2, 20, 20}, {1, 0, 0}, 60}, {&fog, 1}, std::exp(-20.0), pieces);
    EXPECT_GE(pieces.depth, 20);
    EXPECT_LT(pieces.depth, 28.1);
}
}
}
