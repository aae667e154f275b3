// In-scattering per meter at sixteen points (see base/simd/simd.h for how such files are compiled).
#if defined(TYNDALL_INTEGRATE_SCATTERING_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_INTEGRATE_SCATTERING_SIMD_H
#undef TYNDALL_INTEGRATE_SCATTERING_SIMD_H
#else
#define TYNDALL_INTEGRATE_SCATTERING_SIMD_H
#endif

#include "base/simd/simd.h"
#include "integrate/ray_batch.h"
#include "trace/fluence/fluence_simd.h"
#include "trace/lights/light_simd.h"
#include "trace/snapshot.h"
#include "trace/transmittance/light_depth_simd.h"
#include "volume/emission/emission_field_simd.h"
#include "volume/medium.h"
#include "volume/phase_simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
// In-scattering of unit light from one direction: Σ over media of albedo × extinction(medium) × phase function.
template<class Extinction>
HWY_INLINE Vec3s scattering(const std::vector<Medium>& media, const Vec3s& position, const Floats& cosine,
                            const Extinction& extinction) {
    Vec3s sum = splat(vec3(0));
    for (size_t m = 0; m < media.size(); ++m) {
        const Optics& optics = media[m].optics;
        sum = fma(albedo16(optics, position), extinction(m) * phase_value(optics.phase, cosine), sum);
    }
    return sum;
}

// The same with the mean albedo of each medium.
template<class Extinction>
HWY_INLINE Vec3s scattering(const std::vector<Medium>& media, const Floats& cosine, const Extinction& extinction) {
    Vec3s sum = splat(vec3(0));
    for (size_t m = 0; m < media.size(); ++m) {
        const Optics& optics = media[m].optics;
        sum = fma(splat(optics.albedo), extinction(m) * phase_value(optics.phase, cosine), sum);
    }
    return sum;
}

// In-scattering from one light: `scattering` × `amount` of light arriving without fog × transmittance to the light.
HWY_INLINE Vec3s scattered_light(const Light& light, const LightDepth& depth, const Vec3s& position,
                                 const Floats& amount, const Vec3s& scattering) {
    const Mask16 wanted = amount > 0.0f;
    const Floats transmittance = exp(-light_depth16(depth, position, wanted));
    const Vec3s sum =
        scattering * zero_unless(wanted, amount * transmittance) * splat(light.intensity * light.volume_scale);
    return light.filter && has_colors(*light.filter) ? sum * tint_at(light, position) : sum;
}

// SIMD version of source_radiance(); leaves out emission unless `emits`.
HWY_INLINE Vec3s source16(const Optics& optics, vec3 ambient, bool emits, const Vec3s& position) {
    if (!optics.albedo_field) return splat(emits ? source_radiance(optics, ambient) : optics.albedo * ambient);
    const vec3 own = emits ? optics.emission.radiance / optics.extinction : vec3(0);
    return albedo16(optics, position) * splat(ambient) + splat(own);
}

// Emission, scattered ambient light and, with a fluence grid, multiple scattering, per meter.
template<class Extinction>
HWY_INLINE Vec3s other_source(const Snapshot& snapshot, const FluenceGrid* fluence, const Vec3s& position,
                              const Vec3s& direction, const Extinction& extinction) {
    Vec3s sum = splat(vec3(0));
    for (size_t m = 0; m < snapshot.media.size(); ++m)
        sum = fma(source16(snapshot.media[m].optics, snapshot.ambient, true, position), extinction(m), sum);
    return fluence ? sum + scattered_fluence(*fluence, snapshot.media, position, direction, extinction) : sum;
}

// One kind of that light only.
template<class Extinction>
HWY_INLINE Vec3s other_source(OtherLight light, const Snapshot& snapshot, const FluenceGrid* fluence,
                              const Vec3s& position, const Vec3s& direction, const Extinction& extinction) {
    Vec3s sum = splat(vec3(0));
    if (light == OtherLight::multiple)
        return fluence ? scattered_fluence(*fluence, snapshot.media, position, direction, extinction) : sum;
    const bool emits = light == OtherLight::emission;
    for (size_t m = 0; m < snapshot.media.size(); ++m)
        sum = fma(source16(snapshot.media[m].optics, emits ? vec3(0) : snapshot.ambient, emits, position),
                  extinction(m), sum);
    return sum;
}
}
HWY_AFTER_NAMESPACE();
#endif
