// Builds the leaves of a recipe: the voxel grid, the leaves that may contain fog, and their values.
#include "base/error.h"
#include "base/parallel.h"
#include "volume/bricks/voxel_mask.h"
#include "volume/recipe/growth.h"
#include "volume/recipe/leaf.h"

#include <glm/gtc/matrix_transform.hpp>

#include <array>
#include <cassert>
#include <string>

namespace tyndall {
namespace {
struct VoxelGrid {
    ivec3 size{0};                        // voxels
    std::array<std::vector<float>, 3> at; // coordinates of voxel centers relative to the center; padded to whole leaves
};

VoxelGrid voxel_grid(const FogRecipe& recipe) {
    const dvec3 size = dvec3(recipe.bounds.high) - dvec3(recipe.bounds.low);
    const dvec3 count = glm::ceil(size / recipe.voxel_size - 0.5);
    if (!(std::min({count.x, count.y, count.z}) >= 1))
        refuse("voxel_size",
               std::to_string(recipe.voxel_size) + " m is too large for the bounds: no voxel center fits");
    if (!(count.x * count.y * count.z <= 0x1p33))
        fail(ExitCode::out_of_memory, "voxel_size",
             std::to_string(recipe.voxel_size) +
                 " m divides the bounds into more than 8.6e9 voxels; use larger voxels");

    VoxelGrid grid;
    grid.size = ivec3(count);
    for (int axis = 0; axis < 3; ++axis) {
        // Padding voxels of the last leaf are placed far outside.
        constexpr float far_away = 1e9f;
        grid.at[axis].assign((grid.size[axis] + 7) / 8 * 8, far_away);
        for (int i = 0; i < grid.size[axis]; ++i)
            grid.at[axis][i] = static_cast<float>((i + 0.5) * recipe.voxel_size - 0.5 * size[axis]);
    }
    return grid;
}

// The cubes of `width` voxels at `origins` that may contain fog.
std::vector<ivec3> cubes_with_fog(const FogField& field, const VoxelGrid& grid, const std::vector<ivec3>& origins,
                                  int width) {
    std::vector<ivec3> result;
    for (size_t first = 0; first < origins.size(); first += 16) {
        const size_t some = std::min<size_t>(16, origins.size() - first);
        FogBoxes boxes;
        for (size_t i = 0; i < 16; ++i) {
            const ivec3 low = origins[first + std::min(i, some - 1)], high = glm::min(low + width, grid.size) - 1;
            for (int axis = 0; axis < 3; ++axis)
                boxes.low[axis][i] = grid.at[axis][low[axis]], boxes.high[axis][i] = grid.at[axis][high[axis]];
        }
        const uint32_t bits = boxes_with_fog(field, boxes);
        for (size_t i = 0; i < some; ++i)
            if (bits >> i & 1) result.push_back(origins[first + i]);
    }
    return result;
}

// Appends the cubes of `width` voxels that overlap low..high.
void add_cubes(std::vector<ivec3>& cubes, ivec3 low, ivec3 high, int width) {
    for (int x = low.x; x < high.x; x += width)
        for (int y = low.y; y < high.y; y += width)
            for (int z = low.z; z < high.z; z += width) cubes.emplace_back(x, y, z);
}

bool before(ivec3 a, ivec3 b) { return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z; }

// Finds leaves that may contain fog from coarse to fine: blocks of 64³ voxels in parallel, cubes of 16³, leaves of 8³.
std::vector<ivec3> leaves_to_try(const FogField& field, const VoxelGrid& grid) {
    constexpr int block_width = 64, cube_width = 16;
    std::vector<ivec3> blocks;
    add_cubes(blocks, ivec3(0), grid.size, block_width);
    std::vector<std::vector<ivec3>> found(blocks.size());
    parallel_for(static_cast<int64_t>(blocks.size()), [&](int64_t b) {
        std::vector<ivec3> cubes, leaves;
        add_cubes(cubes, blocks[b], glm::min(blocks[b] + block_width, grid.size), cube_width);
        for (const ivec3 cube : cubes_with_fog(field, grid, cubes, cube_width))
            add_cubes(leaves, cube, glm::min(cube + cube_width, grid.size), 8);
        found[b] = cubes_with_fog(field, grid, leaves, 8);
    });
    std::vector<ivec3> result;
    for (const auto& leaves : found) result.insert(result.end(), leaves.begin(), leaves.end());
    std::sort(result.begin(), result.end(), before);
    return result;
}

// A box of voxels, inclusive; high < low = empty.
struct ActiveBox {
    ivec3 low{std::numeric_limits<int>::max()}, high{std::numeric_limits<int>::min()};

    bool empty() const { return high.x < low.x; }
};
}

RecipeGrid make_recipe_grid(const FogRecipe& recipe, double seconds) {
    VoxelGrid grid = voxel_grid(recipe);
    RecipeGrid growth;
    const double step = recipe.voxel_size;
    growth.index_to_world = glm::scale(glm::translate(dmat4(1), dvec3(recipe.bounds.low) + 0.5 * step), dvec3(step));
    growth.field = fog_field(recipe, seconds);
    growth.origins = leaves_to_try(growth.field, grid);
    growth.size = grid.size;
    growth.at = std::move(grid.at);
    return growth;
}

int generate_leaf(const RecipeGrid& growth, size_t number, Leaf& density, Leaf* kelvin) {
    assert(growth.field.fire.burns == (kelvin != nullptr));
    const ivec3 origin = growth.origins[number];
    const float *x = &growth.at[0][origin.x], *y = &growth.at[1][origin.y], *z = &growth.at[2][origin.z];
    density.origin = origin;
    if (!kelvin) return fill_leaf(growth.field, x, y, z, density.values);
    kelvin->origin = origin;
    return fill_leaf(growth.field, x, y, z, density.values, kelvin->values);
}

namespace {
// All nonempty leaves. grow_one(number, leaf) fills one and returns how many voxels needed all octaves.
template<class GrowOne>
SparseVolume generated(const RecipeGrid& growth, const GrowOne& grow_one, GenerateReport* report) {
    SparseVolume volume;
    volume.index_to_world = growth.index_to_world;

    // Fill in place, then compact to remove empty leaves.
    const size_t count = growth.origins.size();
    volume.leaves.reserve(count);
    for (size_t i = 0; i < count; ++i) volume.leaves.emplace_back(Unfilled{});
    std::vector<ActiveBox> active(count);
    std::vector<int> finished(count), voxels(count);
    parallel_ranges(static_cast<int64_t>(count), 8, [&](int64_t begin, int64_t end) {
        for (int64_t i = begin; i < end; ++i) {
            Leaf& leaf = volume.leaves[i];
            finished[i] = grow_one(static_cast<size_t>(i), leaf);
            const VoxelMask mask = voxels_above(leaf.values, 0);
            voxels[i] = static_cast<int>(count_voxels(mask));
            if (voxels[i] == 0) continue;
            bounds_of(mask, active[i].low, active[i].high);
            active[i].low += leaf.origin, active[i].high += leaf.origin;
        }
    });

    const ivec3 leaves = (growth.size + 7) / 8;
    GenerateReport work{.leaves = int64_t{leaves.x} * leaves.y * leaves.z, .tried = static_cast<int64_t>(count)};
    ActiveBox all;
    size_t kept = 0;
    for (size_t i = 0; i < count; ++i) {
        work.finished += finished[i], work.voxels += voxels[i];
        if (active[i].empty()) {
            work.wasted += finished[i];
            continue;
        }
        all.low = glm::min(all.low, active[i].low), all.high = glm::max(all.high, active[i].high);
        if (kept != i) volume.leaves[kept] = volume.leaves[i];
        ++kept;
    }
    volume.leaves.resize(kept);
    if (kept > 0) volume.active_low = all.low, volume.active_high = all.high;
    work.kept = static_cast<int64_t>(kept);
    if (report) *report = work;
    return volume;
}
}

SparseVolume generate(const FogRecipe& recipe, double seconds, GenerateReport* report) {
    const RecipeGrid growth = make_recipe_grid(recipe, seconds);
    const auto fog = [&](size_t number, Leaf& leaf) { return generate_leaf(growth, number, leaf, nullptr); };
    const auto smoke = [&](size_t number, Leaf& leaf) {
        Leaf kelvin;
        return generate_leaf(growth, number, leaf, &kelvin);
    };
    SparseVolume volume = recipe.fire ? generated(growth, smoke, report) : generated(growth, fog, report);
    volume.name = recipe.name;
    return volume;
}

SparseVolume generate_temperature(const FogRecipe& recipe, double seconds) {
    SparseVolume volume;
    if (recipe.fire) {
        const RecipeGrid growth = make_recipe_grid(recipe, seconds);
        const auto kelvin = [&](size_t number, Leaf& leaf) {
            Leaf density;
            return generate_leaf(growth, number, density, &leaf);
        };
        volume = generated(growth, kelvin, nullptr);
    }
    volume.name = temperature_name;
    return volume;
}
}
