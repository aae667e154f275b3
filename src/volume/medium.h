// Fog at one moment: where it is, how dense, and what it does to light.
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

// Where a medium is, and how dense.
enum class DensityKind { homogeneous, height, bricks };
struct Density {
    DensityKind kind = DensityKind::homogeneous;
    Box bounds = everywhere(); // local box of a homogeneous or height medium
    mat4 world_to_local{1};    // of those bounds; bricks carry their own transform
    float height_base = 0;     // exp(-(y - base) / falloff) in world y, at most 1 below base
    float height_falloff = 1;
    std::shared_ptr<const BrickPool> bricks;
};

struct Emission {
    vec3 radiance{0}; // per metre at density 1

    // Of fog that does nothing but emit, by grids: what it emits at a point is scale · emission_at(field, point), and
    // `radiance` its mean.
    std::shared_ptr<const EmissionField> field{};
    vec3 scale{1};
};

struct Optics {
    vec3 extinction{0.1f}; // 1/m at density 1; the same in all channels, as loaders see to
    vec3 albedo{0.95f};    // scattered share of the extinction, 0..1
    Phase phase;
    Emission emission;

    // Where the albedo differs from point to point: base_albedo · albedo_factor(field, point), and `albedo` its mean.
    std::shared_ptr<const AlbedoField> albedo_field{};
    vec3 base_albedo{1};
};

// Fog that takes no light away: nothing collides with it.
inline bool only_emits(const Optics& optics) { return optics.emission.field != nullptr; }

vec3 albedo_at(const Optics& optics, vec3 point);

// What kernels ask for while all media are grey.
inline float grey_extinction(const Optics& optics) {
    assert(optics.extinction.x == optics.extinction.y && optics.extinction.x == optics.extinction.z);
    return optics.extinction.x;
}

// What fog sends on of emission and even light from all around, per unit of its extinction, which is not 0.
inline vec3 source_radiance(const Optics& optics, vec3 ambient) {
    return optics.albedo * ambient + optics.emission.radiance / optics.extinction;
}

struct Medium {
    std::string name;
    Density density;
    Optics optics;
    Box world_bounds = everywhere();

    // Extinction no point of the medium exceeds, 1/m.
    float majorant() const;
};

// Density at a point; 0 outside the medium.
float density_at(const Medium& medium, vec3 point);

// What fog emits at a point, per metre. Of fog without a field it is in proportion to the density.
vec3 emission_at(const Medium& medium, vec3 point);

// Densities at 16 points (x, y, z of 16 each); 0 outside the medium. Kernels use density16() of medium_simd.h.
void densities(const Medium& medium, const float* x, const float* y, const float* z, float* density);

// Optical depth along a ray 0..t_max: exact for homogeneous and height fog; for bricks two Gauss points per voxel cell,
// exact for the trilinear density.
double optical_depth(const Medium& medium, const Ray& ray);
double optical_depth(std::span<const Medium> media, const Ray& ray);
}
