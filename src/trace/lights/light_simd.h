// Light that arrives at sixteen points (see base/simd/simd.h for how such files are compiled).
#if defined(TYNDALL_TRACE_LIGHT_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_TRACE_LIGHT_SIMD_H
#undef TYNDALL_TRACE_LIGHT_SIMD_H
#else
#define TYNDALL_TRACE_LIGHT_SIMD_H
#endif

#include "base/simd/simd.h"
#include "scene/light.h"
#include "trace/lights/light_filter_simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
// Unoccluded irradiance of a light.
struct LightSamples {
    Vec3s to_light; // unit
    Floats distance;
    Floats amount; // factor on the light's intensity; for a colored gobo, its largest channel
};

// The color of a light's gobo relative to its largest channel.
HWY_INLINE Vec3s tint_at(const Light& light, const Vec3s& position) {
    const Vec3s offset = position - splat(light.position);
    return filter_tint(*light.filter, offset * (1.0f / max(sqrt(dot(offset, offset)), 1e-12f)));
}

// Same as arrival() of scene/light.h. `cone`: the light's cone_falloff().
HWY_INLINE LightSamples arrival16(const Light& light, const ConeFalloff& cone, const Vec3s& position) {
    if (is_distant(light)) return {splat(-light.direction), infinity, 1.0f};
    const Vec3s offset = splat(light.position) - position;
    const float reach = capped_radius(light);
    const Floats squared = dot(offset, offset);
    const Floats distance = max(sqrt(squared), 1e-12f);
    LightSamples result{offset * (1.0f / distance), distance, 1.0f / max(squared, reach * reach)};
    if (!std::isinf(light.range)) {
        const Floats share = distance * (1 / light.range), fourth = (share * share) * (share * share);
        result.amount = result.amount * max(min(1.0f - fourth, 1.0f), 0.0f);
    }
    if (has_cone(light)) {
        const Floats cosine = -dot(result.to_light, splat(light.direction));
        const Floats edge = max(min(fma(cosine, cone.scale, cone.offset), 1.0f), 0.0f);
        result.amount = result.amount * edge * edge;
    }
    if (light.filter) result.amount = result.amount * filter_strength(*light.filter, result.to_light * -1.0f);
    return result;
}
}
HWY_AFTER_NAMESPACE();
#endif
