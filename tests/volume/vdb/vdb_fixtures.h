// VDB files for the tests, written by OpenVDB itself and so able to hold what write_vdb() never writes.
#pragma once
#include "base/math.h"
#include "support/expect.h"
#include "support/scratch.h"
#include "volume/bricks/sparse_volume.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tyndall::testing {
struct AuthoredTile {
    ivec3 at{0};
    uint32_t level = 1; // 1, 2, 3: a box of 8, 128, 4096 voxels along each axis
    float value = 0;
    bool active = true;
};

struct AuthoredGrid {
    std::string name = "density";
    std::string type = "float";         // float, double, int32, int64, bool, mask, vec3s, vec3d, vec3i
    std::string grid_class = "unknown"; // of a fog volume the library packs nothing with ZIP
    bool half = false;
    float background = 0;
    dmat4 index_to_world{1};
    bool frustum = false;
    int instance_of = -1;            // shares the tree of an earlier grid
    std::vector<AuthoredTile> tiles; // of float and double grids
    std::vector<std::pair<ivec3, float>> voxels;
    std::vector<std::pair<ivec3, vec3>> colors; // of grids of vectors
    std::vector<std::pair<ivec3, float>> inactive_voxels;
};

inline constexpr uint32_t pack_none = 0, pack_zip = 1, pack_mask = 2, pack_blosc = 4;

// The bytes of a file; `offsets` false is what a stream that cannot seek gets.
std::string authored(const std::vector<AuthoredGrid>& grids, uint32_t packing = pack_mask | pack_blosc,
                     bool offsets = true);

// A ball of noisy density around `center`, spread over several leaves.
AuthoredGrid noisy_ball(ivec3 center, int radius, uint32_t seed = 1);

// Value of a voxel of the volume, 0 where it holds none; fails the test when leaves or tiles overlap there.
float value_at(const SparseVolume& volume, ivec3 voxel);

// Overwrites bytes at a position with a plain value.
template<class T> std::string patched(std::string bytes, size_t position, T value) {
    EXPECT_LE(position + sizeof value, bytes.size());
    return bytes.replace(position, sizeof value, std::string(reinterpret_cast<const char*>(&value), sizeof value));
}
}
