// A fog recipe: noise, remapped to density, shaped by height, throughput by wind and stirred by swirl; on request a
// fire below. A pure function of point and time, baked to VDB files or grown in memory when a scene uses it directly.
#pragma once
#include "volume/bricks/sparse_volume.h"
#include "volume/noise/noise.h"
#include "volume/recipe/fire.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace tyndall {
enum class FogShape { box, ellipsoid };

struct FogRecipe {
    std::string name = "density";
    Box bounds{vec3(-1), vec3(1)}; // metres
    double voxel_size = 0.05;      // metres
    FractalNoise noise;
    // density = clamp((noise01 - threshold) · gain, 0, 1), smoothed over `soft_edge` of noise01 above the threshold,
    // faded to 0 over `border` metres at the sides of the bounds; noise01 = (noise + 1) / 2
    float threshold = 0.5f;
    float gain = 2;
    float soft_edge = 0;
    vec3 border{0}; // metres, along each axis
    // ellipsoid: fills the bounds, its widest level at `shape_level` of their height; the threshold is lowered by
    // `shape_strength` at its centre and raised by as much at its surface, beyond which there is nothing
    FogShape shape = FogShape::box;
    float shape_strength = 0.3f;
    float shape_level = 0.5f; // 0..1; low = flat underneath
    // · exp(-(y - base) / falloff) above base, 1 below; falloff 0 = off
    float height_base = 0, height_falloff = 0;
    vec3 wind{0};                   // metres per second
    float swirl = 0;                // metres (root mean square) that curl noise displaces the coordinates by
    float swirl_scale = 1;          // metres per cell of the curl noise
    float swirl_speed = 0;          // turns per second
    std::optional<FireRecipe> fire; // then the rest is its smoke
    // seconds; > 0 makes every motion repeat exactly after it: turns are rounded to whole ones per loop (at least one);
    // wind keeps its speed and carries two layers, each of which fades out before it starts over
    double period = 0;
    // optics the author had in mind, written as metadata and used when a scene does not say otherwise
    float extinction = 0.1f; // 1/m at density 1
    vec3 albedo{0.95f};
    float g = 0.3f;
    double frame_rate = 24;
};

// Densities below this are 0: half floats lose their digits there.
inline constexpr float min_density = 1.0f / 16384;

// What grids are called beside that of the density.
inline constexpr const char *temperature_name = "temperature", *velocity_name = "vel";

// Throws Error (refused, unreadable) naming file and field.
FogRecipe read_recipe(const std::filesystem::path& file);

// Density at points at a moment (structure of arrays): the definition the bake samples at voxel centres.
void recipe_density(const FogRecipe& recipe, double seconds, std::span<const float> x, std::span<const float> y,
                    std::span<const float> z, std::span<float> density);

// Kelvin, the same way: of the fire's flame `edge` to `core`, of its smoke elsewhere `air`, 0 where there is neither.
// All 0 without a fire.
void recipe_temperature(const FogRecipe& recipe, double seconds, std::span<const float> x, std::span<const float> y,
                        std::span<const float> z, std::span<float> kelvin);

// Metres per second at which what is there is advected: in flames (where `kelvin` has a fire's edge or more) the fire's
// rise, elsewhere the wind, both as the swirl bends them; with D its displacement, (1 + ∇D)⁻¹ (advection - ∂D/∂t), or
// without the inverse where the swirl folds space. Not what `evolve` does, which changes places and moves nothing.
void recipe_velocity(const FogRecipe& recipe, double seconds, std::span<const vec3> points,
                     std::span<const float> kelvin, std::span<vec3> velocity);

// How much work the bound of the noise spared.
struct GrowReport {
    int64_t leaves = 0;   // inside the bounds
    int64_t tried = 0;    // not ruled out by a bound of their box
    int64_t kept = 0;     // hold fog
    int64_t voxels = 0;   // hold fog themselves
    int64_t finished = 0; // voxels computed to the last octave, by eights or sixteens
    int64_t wasted = 0;   // those of them in leaves that turned out empty: false positives of the bounds
};

// The non-empty leaves of the recipe at a moment, by ascending origin. Voxel centres lie on
// bounds.low + (i + ½) · voxel_size. Throws Error: refused (no voxel fits), out_of_memory (over 2^33 voxels in the
// bounds).
SparseVolume grow(const FogRecipe& recipe, double seconds, GrowReport* report = nullptr);

// The same of the temperature, kelvin.
SparseVolume grow_temperature(const FogRecipe& recipe, double seconds);

// 32 hex digits over every field that changes the result, the voxel size and the program's format version.
std::string recipe_hash(const FogRecipe& recipe);
}
