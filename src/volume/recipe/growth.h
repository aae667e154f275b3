// The fog of a recipe leaf by leaf, for those who need none of them for long. grow() keeps them all.
#pragma once
#include "volume/bricks/sparse_volume.h"
#include "volume/recipe/field.h"

#include <array>
#include <vector>

namespace tyndall {
struct Growth {
    dmat4 index_to_world{1};
    std::vector<ivec3> origins; // of the leaves that can hold fog, ascending; some turn out empty
    ivec3 size{0};              // voxels within the bounds

    FogField field;
    std::array<std::vector<float>, 3> at; // coordinates of voxel centres from the middle, padded to whole leaves
};

// Throws Error: refused (no voxel fits), out_of_memory (over 2^33 voxels in the bounds).
Growth start_growth(const FogRecipe& recipe, double seconds);

// Computes the leaf of a number, every value of it, and with a fire those of its temperature, which null stands for
// where there is none. Returns how many of its voxels needed all octaves.
int grow_leaf(const Growth& growth, size_t number, Leaf& density, Leaf* kelvin);
}
