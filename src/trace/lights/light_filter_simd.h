// IES profiles and gobos in sixteen directions (see base/simd/simd.h for how such files are compiled).
#if defined(TYNDALL_TRACE_LIGHT_FILTER_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_TRACE_LIGHT_FILTER_SIMD_H
#undef TYNDALL_TRACE_LIGHT_FILTER_SIMD_H
#else
#define TYNDALL_TRACE_LIGHT_FILTER_SIMD_H
#endif

#include "base/simd/angles_simd.h"
#include "base/simd/gather_simd.h"
#include "base/simd/simd.h"
#include "scene/lights/gobo.h"
#include "scene/lights/light_filter.h"
#include "scene/photometry/ies_profile.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
// A direction in the axes of a profile or a gobo.
HWY_INLINE Vec3s across(const LightFilter& filter, const LightAxes& axes, const Vec3s& direction) {
    return {dot(direction, splat(axes.right)), dot(direction, splat(axes.up)), dot(direction, splat(filter.direction))};
}

// Linear interpolation between table entries `index` and `index + 1`.
HWY_INLINE Floats lerp_entries(const float* values, const Ints& index, const Floats& share) {
    Floats first, second;
    gather_pairs(values, index, first, second);
    return fma(share, second - first, first);
}

// Same as profile_factor() of scene/photometry/ies_profile.h. Half-angle formulas keep it well conditioned.
HWY_INLINE Floats profile_share16(const IesProfile& profile, const Vec3s& at) {
    constexpr float tiny = 1e-20f, rounding = 1e-5f;
    const Floats sine = sqrt(fma(at.x, at.x, at.y * at.y));
    const Floats half = atan(sine / max(abs(at.z) + sqrt(fma(at.z, at.z, sine * sine)), tiny)) * 2.0f;
    const Floats vertical = select(at.z < 0.0f, pi - half, half);
    const float rows = static_cast<float>(profile.rows);
    const Floats row = max(min((vertical - profile.first) * profile.rows_per_radian, rows - 1), 0.0f);
    const Floats lower = min(floor(row), rows - 2);
    const Mask16 inside = (vertical >= profile.first - rounding) & (vertical <= profile.last + rounding);
    const Floats share = row - lower;
    const float* values = profile.shares.data();
    if (profile.columns == 1) return zero_unless(inside, lerp_entries(values, truncate(lower), share));

    const Floats turned = atan(at.y / max(abs(at.x) + sine, tiny)) * 2.0f;
    const Floats around = select(at.x < 0.0f, pi - turned, turned);
    const Floats horizontal = select(around < 0.0f, around + 2 * pi, around);
    const float columns = static_cast<float>(profile.columns);
    const Floats column = max(min(horizontal * profile.columns_per_radian, columns - 1), 0.0f);
    const Floats before = min(floor(column), columns - 2);
    const Ints index = truncate(fma(before, rows, lower));
    const Floats one = lerp_entries(values, index, share);
    const Floats next = lerp_entries(values + profile.rows, index, share);
    return zero_unless(inside, fma(column - before, next - one, one));
}

// Texel positions of directions in a gobo, and lookups there.
struct GoboLookup {
    const Gobo::Level& level;
    Ints index;
    Floats right, down; // interpolation weights of the next texel
    Mask16 ahead;       // directions that hit the gobo's plane

    HWY_INLINE GoboLookup(const LightFilter& filter, const Vec3s& direction, int which)
        : level(filter.gobo->levels[static_cast<size_t>(which)]) {
        const Vec3s at = across(filter, filter.gobo_axes, direction);
        ahead = at.z > 1e-6f;
        const Floats inverse = 1.0f / max(at.z, 1e-6f);
        const auto texel_of = [&](const Floats& tangent, float half, float texels, int size) HWY_ATTR {
            const Floats texel = fma(tangent * inverse, 0.5f * texels / half, 0.5f * texels + 0.5f);
            return max(min(texel, static_cast<float>(size - 1)), 0.0f);
        };
        const Floats x = texel_of(at.x, filter.gobo_half.x, level.texels.x, level.size.x);
        const Floats y = texel_of(-at.y, filter.gobo_half.y, level.texels.y, level.size.y);
        const Floats i = min(floor(x), static_cast<float>(level.size.x - 2));
        const Floats j = min(floor(y), static_cast<float>(level.size.y - 2));
        right = x - i, down = y - j;
        index = truncate(j) * level.size.x + truncate(i);
    }
    HWY_INLINE Floats value(int plane) const {
        const float* texels = level.plane(plane);
        const Floats top = lerp_entries(texels, index, right);
        return zero_unless(ahead, fma(down, lerp_entries(texels + level.size.x, index, right) - top, top));
    }
};

// One channel of the factor on a light's intensity, with the gobo at a mip level.
HWY_INLINE Floats filter_channel(const LightFilter& filter, const Vec3s& direction, int channel, int level) {
    Floats factor = 1.0f;
    if (filter.profile) factor = profile_share16(*filter.profile, across(filter, filter.profile_axes, direction));
    if (!filter.gobo) return factor;
    return factor * GoboLookup(filter, direction, level).value(std::min(channel, filter.gobo->planes - 1));
}

// The gobo's color; the factor's largest channel (strength), and the other channels relative to it (tint).
HWY_INLINE Vec3s gobo_color(const LightFilter& filter, const Vec3s& direction, int level) {
    const GoboLookup lookup(filter, direction, level);
    return {lookup.value(0), lookup.value(1), lookup.value(2)};
}
HWY_INLINE Floats filter_strength(const LightFilter& filter, const Vec3s& direction, int level = 0) {
    if (!has_colors(filter)) return filter_channel(filter, direction, 0, level);
    Floats factor = 1.0f;
    if (filter.profile) factor = profile_share16(*filter.profile, across(filter, filter.profile_axes, direction));
    const Vec3s color = gobo_color(filter, direction, level);
    return factor * max(max(color.x, color.y), color.z);
}
HWY_INLINE Vec3s filter_tint(const LightFilter& filter, const Vec3s& direction, int level = 0) {
    const Vec3s color = gobo_color(filter, direction, level);
    return color * (1.0f / max(max(max(color.x, color.y), color.z), 1e-20f));
}
}
HWY_AFTER_NAMESPACE();
#endif
