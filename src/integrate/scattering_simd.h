// What fog scatters towards sixteen eyes per metre (see base/simd/simd.h for how such files are compiled).
#if defined(TYNDALL_INTEGRATE_SCATTERING_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_INTEGRATE_SCATTERING_SIMD_H
#undef TYNDALL_INTEGRATE_SCATTERING_SIMD_H
#else
#define TYNDALL_INTEGRATE_SCATTERING_SIMD_H
#endif

#include "base/simd/simd.h"
#include "integrate/ray_batch.h"
#include "trace/fluence/fluence_simd.h"
#include "trace/light_simd.h"
#include "trace/snapshot.h"
#include "trace/transmittance/light_depth_simd.h"
#include "volume/medium.h"
#include "volume/phase_simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
// Of light of 1 from one side: Σ over media of albedo × extinction(medium) × phase function.
template<class Extinction>
HWY_INLINE Vec3s scattering(const std::vector<Medium>& media, const Floats& cosine, const Extinction& extinction) {
    Vec3s sum = splat(vec3(0));
    for (size_t m = 0; m < media.size(); ++m) {
        const Optics& optics = media[m].optics;
        sum = fused(splat(optics.albedo), extinction(m) * phase_value(optics.phase, cosine), sum);
    }
    return sum;
}

// Of one light: scattering × `amount` of it that would arrive without fog × transmittance of the fog on its way.
HWY_INLINE Vec3s scattered_light(const Light& light, const LightDepth& depth, const Vec3s& position,
                                 const Floats& amount, const Vec3s& scattering) {
    const Mask16 wanted = amount > 0.0f;
    const Floats dimmed = exp(-light_depth16(depth, position, wanted));
    const Vec3s sum = scattering * zero_unless(wanted, amount * dimmed) * splat(light.intensity * light.volume_scale);
    return light.filter && has_colors(*light.filter) ? sum * tint_at(light, position) : sum;
}

// Emission, ambient light and, with a grid, light that has been scattered before: none has a side it comes from.
template<class Extinction>
HWY_INLINE Vec3s glow(const Snapshot& snapshot, const FluenceGrid* fluence, const Vec3s& position,
                      const Vec3s& direction, const Extinction& extinction) {
    Vec3s sum = splat(vec3(0));
    for (size_t m = 0; m < snapshot.media.size(); ++m)
        sum = fused(splat(source_radiance(snapshot.media[m].optics, snapshot.ambient)), extinction(m), sum);
    return fluence ? sum + scattered_fluence(*fluence, snapshot.media, position, direction, extinction) : sum;
}

// One kind of that light alone.
template<class Extinction>
HWY_INLINE Vec3s glow_of(OtherLight light, const Snapshot& snapshot, const FluenceGrid* fluence, const Vec3s& position,
                         const Vec3s& direction, const Extinction& extinction) {
    Vec3s sum = splat(vec3(0));
    if (light == OtherLight::multiple)
        return fluence ? scattered_fluence(*fluence, snapshot.media, position, direction, extinction) : sum;
    for (size_t m = 0; m < snapshot.media.size(); ++m) {
        const Optics& optics = snapshot.media[m].optics;
        const vec3 source =
            light == OtherLight::ambient ? optics.albedo * snapshot.ambient : source_radiance(optics, vec3(0));
        sum = fused(splat(source), extinction(m), sum);
    }
    return sum;
}
}
HWY_AFTER_NAMESPACE();
#endif
