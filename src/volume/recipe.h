// A fog recipe: noise, remapped to density, shaped by height, carried by wind and stirred by swirl; a pure function of
// point and time. Baked to VDB files, or grown in memory when a scene uses it directly.
#pragma once
#include "volume/noise.h"
#include "volume/sparse_volume.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace tyndall {
struct FogRecipe {
    std::string name = "density";
    Box bounds{vec3(-1), vec3(1)};   // metres
    float voxel_size = 0.05f;        // metres
    FractalNoise noise;
    // density = clamp((noise01 - threshold) · gain, 0, 1), smoothed over `soft_edge` of noise01 above the threshold,
    // faded to 0 over `border` metres at the sides of the bounds; noise01 = (noise + 1) / 2
    float threshold = 0.5f;
    float gain = 2;
    float soft_edge = 0;
    float border = 0;
    // · exp(-(y - base) / falloff) above base, 1 below; falloff 0 = off
    float height_base = 0, height_falloff = 0;
    vec3 wind{0};                    // metres per second
    float swirl = 0;                 // metres that curl noise displaces the coordinates by
    float swirl_scale = 1;           // metres per cell of the curl noise
    float swirl_speed = 0;           // turns per second
    double period = 0;               // seconds; > 0 makes every motion repeat exactly after it
    // optics the author had in mind, written as metadata and used when a scene does not say otherwise
    float extinction = 0.1f;         // 1/m at density 1
    vec3 albedo{0.95f};
    float g = 0.3f;
    double frame_rate = 24;
};

// Throws Error (refused, unreadable) naming file and field.
FogRecipe read_recipe(const std::filesystem::path& file);

// Density at points at a moment (structure of arrays): the definition the bake samples at voxel centres.
void recipe_density(const FogRecipe& recipe, double seconds, std::span<const float> x, std::span<const float> y,
                    std::span<const float> z, std::span<float> density);

// The non-empty leaves of the recipe at a moment. Voxel centres lie on bounds.low + (i + ½) · voxel_size.
SparseVolume grow(const FogRecipe& recipe, double seconds);

// 32 hex digits over every field that changes the result, the voxel size and the program's format version.
std::string recipe_hash(const FogRecipe& recipe);
}
