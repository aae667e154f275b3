// Density at single points, and the SIMD sampler behind a plain interface.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "volume/medium.cpp"
#include <hwy/foreach_target.h>

#include "volume/emission/emission_field.h"
#include "volume/medium.h"
#include "volume/medium_simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
void densities_kernel(const Medium& medium, const float* x, const float* y, const float* z, float* density) {
    store(density16(medium, {load(x), load(y), load(z)}), density);
}
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
HWY_EXPORT(densities_kernel);
void densities(const Medium& medium, const float* x, const float* y, const float* z, float* density) {
    HWY_DYNAMIC_DISPATCH(densities_kernel)(medium, x, y, z, density);
}

float Medium::majorant() const {
    return gray_extinction(optics) * (density.kind == DensityKind::bricks ? density.bricks->highest : 1.0f);
}

float fog_detail(std::span<const Medium> media) {
    constexpr float voxels = 4; // that a noise's last octave spans
    float detail = infinity;
    for (const Medium& medium : media) {
        if (medium.density.kind != DensityKind::bricks) continue;
        const vec3 voxel = medium.density.bricks->voxel_size;
        detail = std::min(detail, voxels * std::min(voxel.x, std::min(voxel.y, voxel.z)));
    }
    return detail;
}

vec3 albedo_at(const Optics& optics, vec3 point) {
    return optics.albedo_field ? optics.base_albedo * albedo_factor(*optics.albedo_field, point) : optics.albedo;
}

vec3 emission_at(const Medium& medium, vec3 point) {
    const Emission& emission = medium.optics.emission;
    return emission.field ? emission.scale * emission_at(*emission.field, point)
                          : emission.radiance * density_at(medium, point);
}

float density_at(const Medium& medium, vec3 point) {
    if (medium.density.kind == DensityKind::bricks) return sample_density(*medium.density.bricks, point);
    const vec3 local(medium.density.world_to_local * vec4(point, 1));
    const Box& box = medium.density.bounds;
    const bool inside =
        glm::all(glm::greaterThanEqual(local, box.low)) && glm::all(glm::lessThanEqual(local, box.high));
    if (!inside) return 0;
    if (medium.density.kind == DensityKind::homogeneous) return 1;
    return std::exp(-std::max(point.y - medium.density.height_base, 0.0f) / medium.density.height_falloff);
}
}
#endif
