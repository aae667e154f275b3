// A fog recipe: noise remapped to density, shaped by height, advected by wind and stirred by swirl, with an optional
// fire. A pure function of point and time, baked to VDB files or evaluated in memory when a scene uses it directly.
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
    Box bounds{vec3(-1), vec3(1)}; // meters
    double voxel_size = 0.05;      // meters
    FractalNoise noise;
    // density = clamp((noise01 - threshold) · gain, 0, 1), smoothed over `soft_edge` of noise01 above the threshold,
    // faded to 0 over `border` meters at the sides of the bounds; noise01 = (noise + 1) / 2
    float threshold = 0.5f;
    float gain = 2;
    float soft_edge = 0;
    vec3 border{0}; // meters, along each axis
    // ellipsoid: fills the bounds and is widest at `shape_level` of their height; the threshold is lowered by
    // `shape_strength` at the center and raised by as much at the surface, outside of which there is no fog
    FogShape shape = FogShape::box;
    float shape_strength = 0.3f;
    float shape_level = 0.5f; // 0..1; low = flat base
    // · exp(-(y - base) / falloff) above base, 1 below; falloff 0 = off
    float height_base = 0, height_falloff = 0;
    vec3 wind{0};                   // meters per second
    float swirl = 0;                // RMS displacement of the coordinates by curl noise, meters
    float swirl_scale = 1;          // meters per cell of the curl noise
    float swirl_speed = 0;          // turns per second
    std::optional<FireRecipe> fire; // if set, the rest is its smoke
    // seconds; > 0 makes all motion loop exactly: rotations are rounded to whole turns per loop (at least one), and the
    // wind keeps its speed by advecting two layers, each of which fades out before it restarts
    double period = 0;
    // intended optics, written as metadata and used unless a scene overrides them
    float extinction = 0.1f; // 1/m at density 1
    vec3 albedo{0.95f};
    float g = 0.3f;
    double frame_rate = 24;
};

// Densities below this are set to 0: half floats are subnormal there.
inline constexpr float min_density = 1.0f / 16384;

// Names of the grids other than density.
inline constexpr const char *temperature_name = "temperature", *velocity_name = "vel";

// Throws Error (refused, unreadable) naming file and field.
FogRecipe read_recipe(const std::filesystem::path& file);

// Density at points at one time (structure of arrays): the reference that a bake samples at voxel centers.
void recipe_density(const FogRecipe& recipe, double seconds, std::span<const float> x, std::span<const float> y,
                    std::span<const float> z, std::span<float> density);

// Temperature in kelvin, likewise: `edge` to `core` in the fire's flame, `air` in its smoke, 0 elsewhere.
void recipe_temperature(const FogRecipe& recipe, double seconds, std::span<const float> x, std::span<const float> y,
                        std::span<const float> z, std::span<float> kelvin);

// Velocity in meters per second: in flames (where `kelvin` is at least the fire's edge) the fire's rise, elsewhere the
// wind, both distorted by the swirl. With D its displacement, (1 + ∇D)⁻¹ (advection - ∂D/∂t), without the inverse where
// the swirl folds space. Excludes `evolve`, which changes the noise in place.
void recipe_velocity(const FogRecipe& recipe, double seconds, std::span<const vec3> points,
                     std::span<const float> kelvin, std::span<vec3> velocity);

// How much work the noise bounds saved.
struct GenerateReport {
    int64_t leaves = 0;   // inside the bounds
    int64_t tried = 0;    // not culled by the bound over their box
    int64_t kept = 0;     // contain fog
    int64_t voxels = 0;   // with fog
    int64_t finished = 0; // voxels computed to the last octave, in vectors of eight or sixteen
    int64_t wasted = 0;   // of these, in leaves that turned out empty: false positives of the bounds
};

// The nonempty leaves of the recipe at one time, by ascending origin. Voxel centers are at bounds.low + (i + ½) ·
// voxel_size. Throws Error: refused (no voxel fits), out_of_memory (over 2^33 voxels in the bounds).
SparseVolume generate(const FogRecipe& recipe, double seconds, GenerateReport* report = nullptr);

// The same for the temperature, kelvin.
SparseVolume generate_temperature(const FogRecipe& recipe, double seconds);

// 32 hex digits over every field that changes the result, the voxel size and the program's format version.
std::string recipe_hash(const FogRecipe& recipe);
}
