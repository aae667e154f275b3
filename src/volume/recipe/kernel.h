// Density of a fog field at sixteen points, and which of sixteen boxes may contain fog; included by kernel files only.
#if defined(TYNDALL_VOLUME_RECIPE_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_VOLUME_RECIPE_KERNEL_H
#undef TYNDALL_VOLUME_RECIPE_KERNEL_H
#else
#define TYNDALL_VOLUME_RECIPE_KERNEL_H
#endif

#include "volume/noise/bound_kernel.h"
#include "volume/noise/column_kernel.h"
#include "volume/noise/curl_kernel.h"
#include "volume/recipe/field.h"

#include <bit>

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
HWY_INLINE Floats clamp01(const Floats& x) { return min(max(x, 0.0f), 1.0f); }
HWY_INLINE Floats smoothstep01(const Floats& x) {
    const Floats t = clamp01(x);
    return t * t * (3.0f - 2.0f * t);
}

// Squared normalized distance: 0 at the center of the shape, 1 on its surface.
HWY_INLINE Floats squared_shape_distance(const FogField& field, const Vec3s& p) {
    const auto along = [&](const Floats& x, int axis) {
        const Floats d = x - field.shape_center[axis];
        const Floats share = d * select(d < 0.0f, 1 / field.shape_low_axis[axis], 1 / field.shape_high_axis[axis]);
        return share * share;
    };
    return along(p.x, 0) + along(p.y, 1) + along(p.z, 2);
}

// Density scale independent of the noise: bounds, border, height, and 0 outside the shape.
HWY_INLINE Floats envelope(const FogField& field, const Vec3s& p, const Floats& height, const Floats& shape_distance) {
    Floats result = 1.0f;
    const auto fade_side = [&](const Floats& x, int axis) {
        const Floats inside = field.half_size[axis] - abs(x);
        if (field.border[axis] > 0) result = result * smoothstep01(inside * (1 / field.border[axis]));
        result = zero_unless(inside >= 0.0f, result);
    };
    fade_side(p.x, 0), fade_side(p.y, 1), fade_side(p.z, 2);
    if (field.height_rate > 0) result = result * exp(max(height - field.height_base, 0.0f) * -field.height_rate);
    if (field.shape == FogShape::ellipsoid) result = result * smoothstep01((1.0f - shape_distance) * 5.0f);
    return result;
}

// The noise value above which there is fog.
HWY_INLINE Floats needed_noise(const FogField& field, const Floats& shape_distance) {
    const Floats needed = 2 * field.threshold - 1;
    if (field.shape == FogShape::box) return needed;
    return needed - 2 * field.shape_strength * (1.0f - 2.0f * shape_distance);
}

HWY_INLINE Vec3s displacement(const FogField& field, const Vec3s& p) {
    Vec3s result;
    for (size_t i = 0; i < vectors_per_packet; ++i) {
        const FloatVec3 curl = noise_curl(field.swirl, p.x.part[i], p.y.part[i], p.z.part[i]);
        result.x.part[i] = curl.x, result.y.part[i] = curl.y, result.z.part[i] = curl.z;
    }
    return result * field.swirl_gain;
}

// Sums octaves; stops early with a value below every threshold once no lane can still exceed `needed`.
HWY_INLINE FloatVec sum_of_octaves(const NoiseSum& sum, FloatVec x, FloatVec y, FloatVec z, FloatVec needed,
                                   int& finished) {
    const FloatTag tag;
    FloatVec total = splat(sum.start);
    for (size_t k = 0; k < sum.octaves.size(); ++k) {
        if (hn::AllFalse(tag, hn::Gt(hn::Add(total, splat(sum.rest[k])), needed))) return splat(-4);
        total = add_octave(sum.octaves[k], sum.billow, octave_noise(sum.octaves[k], x, y, z), total);
    }
    finished += static_cast<int>(lane_step);
    return total;
}

// sum_of_octaves() along a column of eight x, each dropped once no lane can still exceed its `needed`.
HWY_INLINE void sums_along_column(const NoiseSum& sum, const float* x, FloatVec y, FloatVec z, const FloatVec* needed,
                                  FloatVec* totals, int& finished) {
    const FloatTag tag;
    uint32_t open = 0xff;
    for (int i = 0; i < 8; ++i) totals[i] = splat(sum.start);
    for (size_t k = 0; k < sum.octaves.size(); ++k) {
        for (uint32_t left = open; left != 0; left &= left - 1) {
            const int i = std::countr_zero(left);
            if (!hn::AllFalse(tag, hn::Gt(hn::Add(totals[i], splat(sum.rest[k])), needed[i]))) continue;
            totals[i] = splat(-4);
            open &= ~(1u << i);
        }
        if (open == 0) return;
        OctaveColumn octave(sum.octaves[k], y, z);
        for (uint32_t left = open; left != 0; left &= left - 1) {
            const int i = std::countr_zero(left);
            totals[i] = add_octave(sum.octaves[k], sum.billow, octave.at(x[i]), totals[i]);
        }
    }
    finished += static_cast<int>(lane_step) * std::popcount(open);
}

// Density scale and noise threshold at sixteen points.
struct DensityTerms {
    Floats scale, needed, wanted; // wanted: `needed`, or infinity where the scale is negligible
    bool open = false;
};
HWY_INLINE DensityTerms density_terms(const FogField& field, const Vec3s& p) {
    const Floats distance = field.shape == FogShape::box ? 0.0f : squared_shape_distance(field, p);
    DensityTerms result;
    result.scale = envelope(field, p, p.y, distance);
    const Mask16 open = result.scale >= min_density;
    result.open = any(open);
    result.needed = needed_noise(field, distance);
    result.wanted = select(open, result.needed, infinity);
    return result;
}

HWY_INLINE Floats density_of(const FogField& field, const Floats& noise, const DensityTerms& terms) {
    const Floats excess = 0.5f * (noise - terms.needed);
    Floats density = clamp01(excess * field.gain) * terms.scale;
    if (field.soft_edge > 0) density = density * smoothstep01(excess * (1 / field.soft_edge));
    return zero_unless(density >= min_density, density);
}

// Densities at sixteen points. `finished` counts the points that needed every octave.
HWY_INLINE Floats fog_density(const FogField& field, const Vec3s& p, int& finished) {
    const DensityTerms terms = density_terms(field, p);
    if (!terms.open) return 0.0f;
    const Vec3s q = field.swirl_gain == 0 ? p : p + displacement(field, p);
    Floats noise;
    for (size_t i = 0; i < vectors_per_packet; ++i)
        noise.part[i] =
            sum_of_octaves(field.noise, q.x.part[i], q.y.part[i], q.z.part[i], terms.wanted.part[i], finished);
    return density_of(field, noise, terms);
}

// fog_density() without swirl, at eight x along a column.
HWY_INLINE void fog_column(const FogField& field, const float* x, const Floats& y, const Floats& z, Floats* densities,
                           int& finished) {
    DensityTerms terms[8];
    Floats noise[8];
    for (int i = 0; i < 8; ++i) terms[i] = density_terms(field, {x[i], y, z});
    for (size_t part = 0; part < vectors_per_packet; ++part) {
        FloatVec wanted[8], totals[8];
        for (int i = 0; i < 8; ++i) wanted[i] = terms[i].wanted.part[part];
        sums_along_column(field.noise, x, y.part[part], z.part[part], wanted, totals, finished);
        for (int i = 0; i < 8; ++i) noise[i].part[part] = totals[i];
    }
    for (int i = 0; i < 8; ++i) densities[i] = terms[i].open ? density_of(field, noise[i], terms[i]) : 0.0f;
}

// True for boxes that may contain fog (conservative). Boxes bound the sample points, inclusive.
HWY_INLINE Mask16 may_hold_fog(const FogField& field, const Vec3s& low, const Vec3s& high) {
    const auto nearest = [&](vec3 to) {
        return Vec3s{min(max(to.x, low.x), high.x), min(max(to.y, low.y), high.y), min(max(to.z, low.z), high.z)};
    };
    // All terms except the noise decrease with the distance from some point: each is largest at the box's nearest
    // point.
    const Floats distance =
        field.shape == FogShape::box ? 0.0f : squared_shape_distance(field, nearest(field.shape_center)) * 0.9999f;
    const Floats scale = envelope(field, nearest(vec3(0)), low.y, distance);
    const Mask16 open = scale * 1.0001f >= min_density;
    if (!any(open)) return open;

    Vec3s grown_low = low, grown_high = high;
    if (field.swirl_gain != 0) {
        const Vec3s middle = (low + high) * 0.5f, half = (high - low) * 0.5f, moved = displacement(field, middle);
        const Floats spread =
            min((half.x + half.y + half.z) * field.swirl_stretch, 2 * field.swirl_reach) + field.swirl_reach * 1e-5f;
        const Vec3s around{spread, spread, spread};
        grown_low = low + moved - around, grown_high = high + moved + around;
    }
    Floats bound;
    for (size_t i = 0; i < vectors_per_packet; ++i) {
        const Boxes boxes{{{grown_low.x.part[i], grown_high.x.part[i]},
                           {grown_low.y.part[i], grown_high.y.part[i]},
                           {grown_low.z.part[i], grown_high.z.part[i]}}};
        bound.part[i] = sum_bound(field.noise, boxes);
    }
    return open & (bound + 1e-4f > needed_noise(field, distance));
}
}
HWY_AFTER_NAMESPACE();
#endif
