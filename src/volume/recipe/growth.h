// Leaf-by-leaf evaluation of a recipe, for streaming uses; generate() keeps all leaves.
#pragma once
#include "volume/bricks/sparse_volume.h"
#include "volume/recipe/field.h"

#include <array>
#include <vector>

namespace tyndall {
struct RecipeGrid {
    dmat4 index_to_world{1};
    std::vector<ivec3> origins; // of the leaves that may contain fog, ascending; some turn out empty
    ivec3 size{0};              // voxels within the bounds

    FogField field;
    std::array<std::vector<float>, 3> at; // voxel center coordinates relative to the center, padded to whole leaves
};

// Throws Error: refused (no voxel fits), out_of_memory (over 2^33 voxels in the bounds).
RecipeGrid make_recipe_grid(const FogRecipe& recipe, double seconds);

// Fills the density and, for a recipe with fire, the temperature of leaf `number`; `kelvin` must be null without fire.
// Returns how many of its voxels needed all octaves.
int generate_leaf(const RecipeGrid& growth, size_t number, Leaf& density, Leaf* kelvin);
}
