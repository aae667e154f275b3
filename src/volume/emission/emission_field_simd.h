// Emission and albedo at sixteen points, for kernels compiled per instruction set (see base/simd/simd.h).
#if defined(TYNDALL_VOLUME_EMISSION_EMISSION_FIELD_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_VOLUME_EMISSION_EMISSION_FIELD_SIMD_H
#undef TYNDALL_VOLUME_EMISSION_EMISSION_FIELD_SIMD_H
#else
#define TYNDALL_VOLUME_EMISSION_EMISSION_FIELD_SIMD_H
#endif

#include "base/simd/gather_simd.h"
#include "volume/emission/blackbody.h"
#include "volume/emission/emission_field.h"
#include "volume/medium_simd.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
HWY_INLINE Vec3s sampled16(const std::array<std::shared_ptr<const BrickPool>, 3>& pools, const Vec3s& point) {
    const Floats first = brick_density(*pools[0], point);
    if (pools[1] == pools[0]) return {first, first, first};
    return {first, brick_density(*pools[1], point), brick_density(*pools[2], point)};
}

// SIMD version of BlackbodyTable::at().
HWY_INLINE Vec3s blackbody16(const BlackbodyTable& table, const Floats& kelvin) {
    const Floats inside = max(min(kelvin, BlackbodyTable::highest), BlackbodyTable::lowest);
    Ints bits, entry;
    for (size_t i = 0; i < vectors_per_packet; ++i) {
        bits.part[i] = hn::BitCast(IntTag(), inside.part[i]);
        entry.part[i] = hn::ShiftRight<BlackbodyTable::shift>(bits.part[i]);
    }
    const Floats share = to_floats(bits & ((1 << BlackbodyTable::shift) - 1)) * (1.0f / (1 << BlackbodyTable::shift));
    const Ints at = entry - BlackbodyTable::first;
    const Mask16 warm = kelvin > BlackbodyTable::lowest;
    const auto channel = [&](int c) HWY_ATTR {
        Floats low, high;
        gather_pairs(table.channel(c), at, low, high);
        return zero_unless(warm, fma(high - low, share, low));
    };
    return {channel(0), channel(1), channel(2)};
}

// SIMD version of albedo_factor().
HWY_NOINLINE inline Vec3s albedo_factor16(const AlbedoField& field, const Vec3s& point) {
    const Floats coverage = brick_density(*field.coverage, point);
    const Mask16 some = coverage > 0.0f;
    const Floats inverse = 1.0f / select(some, coverage, 1.0f);
    const Vec3s color = sampled16(field.color, point);
    const auto channel = [&](const Floats& c) HWY_ATTR { return select(some, min(c * inverse, 1.0f), 1.0f); };
    return {channel(color.x), channel(color.y), channel(color.z)};
}

// SIMD version of albedo_at() (volume/medium.h).
HWY_INLINE Vec3s albedo16(const Optics& optics, const Vec3s& point) {
    if (!optics.albedo_field) return splat(optics.albedo);
    return splat(optics.base_albedo) * albedo_factor16(*optics.albedo_field, point);
}

// SIMD version of emission_at() for fields, times the medium's scale.
HWY_NOINLINE inline Vec3s emission16(const Emission& emission, const Vec3s& point) {
    const EmissionField& field = *emission.field;
    Vec3s rgb = field.table ? blackbody16(*field.table, brick_density(*field.source[0], point))
                            : sampled16(field.source, point);
    if (field.strength) rgb = rgb * brick_density(*field.strength, point);
    if (field.absorber) rgb = rgb * brick_density(*field.absorber, point);
    if (field.albedo) rgb = rgb * (splat(vec3(1)) - splat(field.base_albedo) * albedo_factor16(*field.albedo, point));
    return rgb * splat(emission.scale);
}
}
HWY_AFTER_NAMESPACE();
#endif
