// Participating media at one instant: extent, density and optical properties.
#pragma once
#include "base/math.h"
#include "volume/phase.h"

#include <cassert>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace tyndall {
struct AlbedoField;
struct BrickPool;
struct EmissionField;

// The extent and density of a medium.
enum class DensityKind { homogeneous, height, bricks };
struct Density {
    DensityKind kind = DensityKind::homogeneous;
    Box bounds = everywhere(); // local box of homogeneous and height fog
    mat4 world_to_local{1};    // for those bounds; bricks have their own transform
    float height_base = 0;     // density exp(-(y - base) / falloff) in world y, clamped to 1 below the base
    float height_falloff = 1;
    std::shared_ptr<const BrickPool> bricks;
};

struct Emission {
    vec3 radiance{0}; // per meter at density 1

    // For emission-only media driven by grids: emission at a point is scale · emission_at(field, point), and `radiance`
    // is its mean.
    std::shared_ptr<const EmissionField> field{};
    vec3 scale{1};
};

struct Optics {
    vec3 extinction{0.1f}; // 1/m at density 1; equal in all channels: their mean
    vec3 albedo{0.95f};    // single-scattering albedo, 0..1
    Phase phase;
    Emission emission;

    // For a spatially varying albedo: base_albedo · albedo_factor(field, point), and `albedo` is its mean.
    std::shared_ptr<const AlbedoField> albedo_field{};
    vec3 base_albedo{1};

    vec3 channels{1}; // extinction of each channel relative to `extinction`, never 0; not 1 = chromatic
};

// True for media that emit but neither absorb nor scatter.
inline bool only_emits(const Optics& optics) { return optics.emission.field != nullptr; }

vec3 albedo_at(const Optics& optics, vec3 point);

// The scalar extinction; in chromatic fog, the mean of the channels.
inline float gray_extinction(const Optics& optics) {
    assert(optics.extinction.x == optics.extinction.y && optics.extinction.x == optics.extinction.z);
    return optics.extinction.x;
}

// The source function in uniform ambient light: albedo · ambient + emission / extinction. Extinction must be nonzero.
inline vec3 source_radiance(const Optics& optics, vec3 ambient) {
    return optics.albedo * ambient + optics.emission.radiance / optics.extinction;
}

struct Medium {
    std::string name;
    Density density;
    Optics optics;
    Box world_bounds = everywhere();

    // Upper bound of the (mean) extinction anywhere in the medium, 1/m.
    float majorant() const;
};

// Whether extinction is the same in all channels.
inline bool is_gray(const Medium& medium) { return medium.optics.channels == vec3(1); }

// Size of the finest detail of the brick media, meters: a noise's last octave spans several voxels.
float fog_detail(std::span<const Medium> media);

// Density at a point; 0 outside the medium.
float density_at(const Medium& medium, vec3 point);

// Emission at a point, per meter. Proportional to the density for media without a field.
vec3 emission_at(const Medium& medium, vec3 point);

// Densities at 16 points (x, y, z arrays of 16); 0 outside the medium. Kernels use density16() from medium_simd.h.
void densities(const Medium& medium, const float* x, const float* y, const float* z, float* density);

// Optical depth along a ray on 0..t_max: analytic for homogeneous and height fog; two Gauss points per voxel cell for
// bricks, which is exact for trilinear density.
double optical_depth(const Medium& medium, const Ray& ray);
double optical_depth(std::span<const Medium> media, const Ray& ray);
}
