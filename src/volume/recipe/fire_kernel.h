// Fire in a fog field at sixteen points, and which of sixteen boxes may contain fire; included by kernel files only.
#if defined(TYNDALL_VOLUME_RECIPE_FIRE_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_VOLUME_RECIPE_FIRE_KERNEL_H
#undef TYNDALL_VOLUME_RECIPE_FIRE_KERNEL_H
#else
#define TYNDALL_VOLUME_RECIPE_FIRE_KERNEL_H
#endif

#include "volume/recipe/kernel.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
struct FlameSample {
    Floats density, kelvin;
};

// Share of the swirl that acts on flames at a height, and the resulting flicker.
HWY_INLINE Floats fire_onset(const FireField& fire, const Floats& y) {
    return smoothstep01((y - fire.base.y) * (fire.per_height / flicker_full));
}
HWY_INLINE Floats flicker_at(const FireField& fire, const Floats& y) {
    return fire.flicker * (flicker_at_base + (1 - flicker_at_base) * fire_onset(fire, y));
}

// Heat without flicker: falls off with the distance from the base.
HWY_INLINE Floats still_heat(const FireField& fire, const Vec3s& p) {
    const Floats x = (p.x - fire.base.x) * fire.per_radius, z = (p.z - fire.base.z) * fire.per_radius;
    const Floats above = p.y - fire.base.y, h = max(above, 0.0f) * fire.per_height;
    const Floats below = min(above, 0.0f) * (4 * fire.per_radius), wider = 1.0f + fire.taper * h;
    return 1.0f - h * h - below * below - (x * x + z * z) * (wider * wider);
}

// Heat at the displaced position; above 0 only where there is flame.
HWY_INLINE Floats fire_heat(const FireField& fire, const Vec3s& p, const Vec3s& displacement, int& finished) {
    const Vec3s q = fma(displacement, fire_onset(fire, p.y), p);
    const Floats still = still_heat(fire, q);
    if (fire.flicker == 0) return still;
    const Floats gain = flicker_at(fire, q.y), needed = -still / gain;
    Floats noise;
    for (size_t i = 0; i < vectors_per_packet; ++i)
        noise.part[i] = sum_of_octaves(fire.noise, q.x.part[i], (q.y * fire.per_stretch).part[i], q.z.part[i],
                                       needed.part[i], finished);
    return still + gain * noise;
}

// Scale of the smoke: 0 below the plume's start, 1 on its axis from half a flame height higher on.
HWY_INLINE Floats plume(const FireField& fire, const Vec3s& nearest, const Floats& highest) {
    const Floats x = nearest.x - fire.base.x, z = nearest.z - fire.base.z;
    const Floats radius = fire.plume_radius + fire.plume_spread * max(highest - fire.base.y, 0.0f);
    const Floats share = (x * x + z * z) / (radius * radius);
    return smoothstep01((highest - fire.plume_low) * fire.plume_rate) * smoothstep01(1.0f - share);
}

HWY_INLINE Mask16 inside_bounds(const FogField& field, const Vec3s& p) {
    return (abs(p.x) <= field.half_size.x) & (abs(p.y) <= field.half_size.y) & (abs(p.z) <= field.half_size.z);
}

// Density and temperature of flame and smoke at sixteen points.
HWY_INLINE FlameSample fire_fog(const FogField& field, const Vec3s& p, int& finished) {
    const FireField& fire = field.fire;
    const Vec3s moved = field.swirl_gain == 0 ? splat(vec3(0)) : displacement(field, p);
    DensityTerms terms = density_terms(field, p);
    terms.scale = terms.scale * plume(fire, p, p.y);
    const Mask16 open = terms.scale >= min_density;
    Floats smoke = 0.0f;
    if (any(open)) {
        const Vec3s q = p + moved;
        const Floats wanted = select(open, terms.needed, infinity);
        Floats noise;
        for (size_t i = 0; i < vectors_per_packet; ++i)
            noise.part[i] =
                sum_of_octaves(field.noise, q.x.part[i], q.y.part[i], q.z.part[i], wanted.part[i], finished);
        smoke = density_of(field, noise, terms);
    }
    const Floats heat = zero_unless(inside_bounds(field, p), clamp01(fire_heat(fire, p, moved, finished)));
    const Floats density = max(smoke, heat * fire.soot);
    FlameSample result;
    result.density = zero_unless(density >= min_density, density);
    result.kelvin = select(heat > 0.0f, fire.edge + fire.span * heat, zero_unless(result.density > 0.0f, fire.air));
    return result;
}

// True for boxes that may contain flame or smoke (conservative).
HWY_INLINE Mask16 may_hold_fire(const FogField& field, const Vec3s& low, const Vec3s& high) {
    const FireField& fire = field.fire;
    const auto nearest = [&](const Vec3s& from, const Vec3s& to) {
        return Vec3s{min(max(fire.base.x, from.x), to.x), min(max(fire.base.y, from.y), to.y),
                     min(max(fire.base.z, from.z), to.z)};
    };
    const Floats reach = field.swirl_reach * 1.0001f;
    const Vec3s around{reach, reach, reach}, grown_low = low - around, grown_high = high + around;
    const Floats still = still_heat(fire, nearest(grown_low, grown_high));
    Floats bound;
    for (size_t i = 0; i < vectors_per_packet; ++i) {
        const Boxes boxes{{{grown_low.x.part[i], grown_high.x.part[i]},
                           {(grown_low.y * fire.per_stretch).part[i], (grown_high.y * fire.per_stretch).part[i]},
                           {grown_low.z.part[i], grown_high.z.part[i]}}};
        bound.part[i] = sum_bound(fire.noise, boxes);
    }
    const Mask16 burns = still + flicker_at(fire, grown_high.y) * max(bound + 1e-4f, 0.0f) > -1e-4f;
    const Mask16 smokes = plume(fire, nearest(low, high), high.y) * 1.0001f >= min_density;
    return burns | (smokes & may_hold_fog(field, low, high));
}
}
HWY_AFTER_NAMESPACE();
#endif
