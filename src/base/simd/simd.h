// Sixteen floats at once, for kernels compiled once per instruction set and chosen at run time (Highway).
//
// A kernel file begins
//     #undef HWY_TARGET_INCLUDE
//     #define HWY_TARGET_INCLUDE "volume/this_file.cpp"
//     #include <hwy/foreach_target.h>
//     #include "base/simd/simd.h"
// puts its kernels in HWY_BEFORE_NAMESPACE(); namespace tyndall::HWY_NAMESPACE { ... } HWY_AFTER_NAMESPACE();
// and ends with #if HWY_ONCE, HWY_EXPORT(kernel) and HWY_DYNAMIC_DISPATCH(kernel)(...).
// Multiply-adds are fused only through fma(), so AVX2 and AVX-512 give bit-identical results.
#if defined(TYNDALL_BASE_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_BASE_SIMD_H
#undef TYNDALL_BASE_SIMD_H
#else
#define TYNDALL_BASE_SIMD_H
#endif

#include "base/math.h"

#include <hwy/highway.h>

#include <cstdint>
#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::ScalableTag<float>;
using IntTag = hn::ScalableTag<int32_t>;
inline constexpr size_t lane_step = HWY_LANES(float);
inline constexpr size_t vectors_per_packet = 16 / lane_step;

struct Mask16 {
    hn::Mask<FloatTag> part[vectors_per_packet];
};

struct Floats {
    hn::Vec<FloatTag> part[vectors_per_packet];

    Floats() = default;
    HWY_INLINE Floats(float value) {
        for (size_t i = 0; i < vectors_per_packet; ++i) part[i] = hn::Set(FloatTag(), value);
    }
};

struct Ints {
    hn::Vec<IntTag> part[vectors_per_packet];

    Ints() = default;
    HWY_INLINE Ints(int32_t value) {
        for (size_t i = 0; i < vectors_per_packet; ++i) part[i] = hn::Set(IntTag(), value);
    }
};

// Applies one Highway operation to every part.
#define TYNDALL_SIMD_UNARY(Type, name, expression)                                                                     \
    HWY_INLINE Type name(const Type& a) {                                                                              \
        Type r;                                                                                                        \
        for (size_t i = 0; i < vectors_per_packet; ++i) r.part[i] = expression;                                        \
        return r;                                                                                                      \
    }
#define TYNDALL_SIMD_BINARY(Result, Type, name, expression)                                                            \
    HWY_INLINE Result name(const Type& a, const Type& b) {                                                             \
        Result r;                                                                                                      \
        for (size_t i = 0; i < vectors_per_packet; ++i) r.part[i] = expression;                                        \
        return r;                                                                                                      \
    }
TYNDALL_SIMD_BINARY(Floats, Floats, operator+, hn::Add(a.part[i], b.part[i]))
TYNDALL_SIMD_BINARY(Floats, Floats, operator-, hn::Sub(a.part[i], b.part[i]))
TYNDALL_SIMD_BINARY(Floats, Floats, operator*, hn::Mul(a.part[i], b.part[i]))
TYNDALL_SIMD_BINARY(Floats, Floats, operator/, hn::Div(a.part[i], b.part[i]))
TYNDALL_SIMD_BINARY(Floats, Floats, min, hn::Min(a.part[i], b.part[i]))
TYNDALL_SIMD_BINARY(Floats, Floats, max, hn::Max(a.part[i], b.part[i]))
TYNDALL_SIMD_BINARY(Mask16, Floats, operator<, hn::Lt(a.part[i], b.part[i]))
TYNDALL_SIMD_BINARY(Mask16, Floats, operator<=, hn::Le(a.part[i], b.part[i]))
TYNDALL_SIMD_BINARY(Mask16, Floats, operator>, hn::Gt(a.part[i], b.part[i]))
TYNDALL_SIMD_BINARY(Mask16, Floats, operator>=, hn::Ge(a.part[i], b.part[i]))
TYNDALL_SIMD_BINARY(Mask16, Floats, operator==, hn::Eq(a.part[i], b.part[i]))
TYNDALL_SIMD_BINARY(Mask16, Mask16, operator&, hn::And(a.part[i], b.part[i]))
TYNDALL_SIMD_BINARY(Mask16, Mask16, operator|, hn::Or(a.part[i], b.part[i]))
TYNDALL_SIMD_UNARY(Mask16, operator!, hn::Not(a.part[i]))
TYNDALL_SIMD_UNARY(Floats, operator-, hn::Neg(a.part[i]))
TYNDALL_SIMD_UNARY(Floats, abs, hn::Abs(a.part[i]))
TYNDALL_SIMD_UNARY(Floats, sqrt, hn::Sqrt(a.part[i]))
TYNDALL_SIMD_UNARY(Floats, floor, hn::Floor(a.part[i]))
TYNDALL_SIMD_BINARY(Ints, Ints, operator+, hn::Add(a.part[i], b.part[i]))
TYNDALL_SIMD_BINARY(Ints, Ints, operator-, hn::Sub(a.part[i], b.part[i]))
TYNDALL_SIMD_BINARY(Ints, Ints, operator*, hn::Mul(a.part[i], b.part[i]))
TYNDALL_SIMD_BINARY(Ints, Ints, operator&, hn::And(a.part[i], b.part[i]))
TYNDALL_SIMD_BINARY(Ints, Ints, operator|, hn::Or(a.part[i], b.part[i]))
TYNDALL_SIMD_BINARY(Ints, Ints, operator^, hn::Xor(a.part[i], b.part[i]))
TYNDALL_SIMD_BINARY(Ints, Ints, min, hn::Min(a.part[i], b.part[i]))
TYNDALL_SIMD_BINARY(Ints, Ints, max, hn::Max(a.part[i], b.part[i]))
#undef TYNDALL_SIMD_UNARY
#undef TYNDALL_SIMD_BINARY

// a·b + c with a single rounding (if the instruction set has it).
HWY_INLINE Floats fma(const Floats& a, const Floats& b, const Floats& c) {
    Floats r;
    for (size_t i = 0; i < vectors_per_packet; ++i) r.part[i] = hn::MulAdd(a.part[i], b.part[i], c.part[i]);
    return r;
}

// where ? a : b
HWY_INLINE Floats select(const Mask16& where, const Floats& a, const Floats& b) {
    Floats r;
    for (size_t i = 0; i < vectors_per_packet; ++i) r.part[i] = hn::IfThenElse(where.part[i], a.part[i], b.part[i]);
    return r;
}
HWY_INLINE Floats zero_unless(const Mask16& where, const Floats& a) {
    Floats r;
    for (size_t i = 0; i < vectors_per_packet; ++i) r.part[i] = hn::IfThenElseZero(where.part[i], a.part[i]);
    return r;
}
HWY_INLINE bool any(const Mask16& a) {
    for (size_t i = 0; i < vectors_per_packet; ++i)
        if (!hn::AllFalse(FloatTag(), a.part[i])) return true;
    return false;
}

HWY_INLINE Floats load(const float* from) { // 16 floats, any alignment
    Floats r;
    for (size_t i = 0; i < vectors_per_packet; ++i) r.part[i] = hn::LoadU(FloatTag(), from + i * lane_step);
    return r;
}
HWY_INLINE void store(const Floats& a, float* to) {
    for (size_t i = 0; i < vectors_per_packet; ++i) hn::StoreU(a.part[i], FloatTag(), to + i * lane_step);
}
HWY_INLINE Ints load(const int32_t* from) {
    Ints r;
    for (size_t i = 0; i < vectors_per_packet; ++i) r.part[i] = hn::LoadU(IntTag(), from + i * lane_step);
    return r;
}
HWY_INLINE void store(const Ints& a, int32_t* to) {
    for (size_t i = 0; i < vectors_per_packet; ++i) hn::StoreU(a.part[i], IntTag(), to + i * lane_step);
}
HWY_INLINE Floats to_floats(const Ints& a) {
    Floats r;
    for (size_t i = 0; i < vectors_per_packet; ++i) r.part[i] = hn::ConvertTo(FloatTag(), a.part[i]);
    return r;
}
HWY_INLINE Ints truncate(const Floats& a) { // toward zero
    Ints r;
    for (size_t i = 0; i < vectors_per_packet; ++i) r.part[i] = hn::ConvertTo(IntTag(), a.part[i]);
    return r;
}
HWY_INLINE Floats gather(const float* base, const Ints& index) {
    Floats r;
    for (size_t i = 0; i < vectors_per_packet; ++i) r.part[i] = hn::GatherIndex(FloatTag(), base, index.part[i]);
    return r;
}
HWY_INLINE Ints gather(const int32_t* base, const Ints& index) {
    Ints r;
    for (size_t i = 0; i < vectors_per_packet; ++i) r.part[i] = hn::GatherIndex(IntTag(), base, index.part[i]);
    return r;
}

// The 4 bytes at each offset; loaded lane by lane, as gather instructions are no faster.
HWY_INLINE hn::Vec<IntTag> words_at(const char* base, const hn::Vec<IntTag>& offset) {
    alignas(64) int32_t at[lane_step];
    hn::Store(offset, IntTag(), at);
    const auto word = [&](int i) HWY_ATTR {
        int32_t value;
        std::memcpy(&value, base + at[i], sizeof value);
        return value;
    };
    const auto four = [&](int i) HWY_ATTR {
        return hn::Vec128<int32_t>{_mm_setr_epi32(word(i), word(i + 1), word(i + 2), word(i + 3))};
    };
#if HWY_TARGET == HWY_AVX2
    return hn::Combine(IntTag(), four(4), four(0));
#else
    const hn::Half<IntTag> half;
    return hn::Combine(IntTag(), hn::Combine(half, four(12), four(8)), hn::Combine(half, four(4), four(0)));
#endif
}

// Converts part i from two half floats per lane, the first in the lower 16 bits.
HWY_INLINE void split_half_pairs(hn::Vec<hn::ScalableTag<uint32_t>> pair, size_t i, Floats& first, Floats& second) {
    using ShortTag = hn::Rebind<uint16_t, hn::ScalableTag<uint32_t>>;
    using HalfTag = hn::Rebind<hwy::float16_t, FloatTag>;
    const auto low = hn::TruncateTo(ShortTag(), hn::And(pair, hn::Set(hn::ScalableTag<uint32_t>(), 0xffffu)));
    const auto high = hn::TruncateTo(ShortTag(), hn::ShiftRight<16>(pair));
    first.part[i] = hn::PromoteTo(FloatTag(), hn::BitCast(HalfTag(), low));
    second.part[i] = hn::PromoteTo(FloatTag(), hn::BitCast(HalfTag(), high));
}
HWY_INLINE void load_half_pairs(const uint32_t* from, Floats& first, Floats& second) {
    for (size_t i = 0; i < vectors_per_packet; ++i)
        split_half_pairs(hn::LoadU(hn::ScalableTag<uint32_t>(), from + i * lane_step), i, first, second);
}

// Gathers two adjacent half floats per lane: base[index] and base[index + 1]. Reads 4 bytes at each index.
HWY_INLINE void gather_half_pairs(const uint16_t* base, const Ints& index, Floats& first, Floats& second) {
    for (size_t i = 0; i < vectors_per_packet; ++i) {
        const auto offset = hn::ShiftLeft<1>(index.part[i]);
        const auto pair = words_at(reinterpret_cast<const char*>(base), offset);
        split_half_pairs(hn::BitCast(hn::ScalableTag<uint32_t>(), pair), i, first, second);
    }
}

// e^x for x <= 88; 0 below -87. Relative error under 2e-7 (Cody–Waite reduction, degree-6 polynomial).
HWY_INLINE Floats exp(const Floats& value) {
    const Floats x = min(max(value, -87.0f), 88.0f);
    const Floats n = floor(fma(x, 1.44269504088896341f, 0.5f));
    Floats r = fma(n, -0.693359375f, x);
    r = fma(n, 2.12194440e-4f, r);
    Floats p = fma(r, 1.9875691500e-4f, 1.3981999507e-3f);
    p = fma(p, r, 8.3334519073e-3f);
    p = fma(p, r, 4.1665795894e-2f);
    p = fma(p, r, 1.6666665459e-1f);
    p = fma(p, r, 5.0000001201e-1f);
    p = fma(p, r * r, r + 1.0f);
    Floats result;
    for (size_t i = 0; i < vectors_per_packet; ++i) {
        const auto exponent = hn::ShiftLeft<23>(hn::Add(hn::ConvertTo(IntTag(), n.part[i]), hn::Set(IntTag(), 127)));
        result.part[i] = hn::Mul(p.part[i], hn::BitCast(FloatTag(), exponent));
    }
    return zero_unless(value > -87.0f, result);
}

// (1 - e^-x) / x for x >= 0, without cancellation: the mean transmittance over an optical depth x.
HWY_INLINE Floats mean_transmittance(const Floats& x) {
    Floats series = fma(x, -1.0f / 5040, 1.0f / 720);
    series = fma(series, -x, 1.0f / 120), series = fma(series, -x, 1.0f / 24);
    series = fma(series, -x, 1.0f / 6), series = fma(series, -x, 0.5f), series = fma(series, -x, 1.0f);
    const Mask16 small = x < 0.35f;
    if (!any(!small)) return series;
    return select(small, series, (1.0f - exp(-x)) / max(x, 0.35f));
}

// Sixteen vectors.
struct Vec3s {
    Floats x, y, z;
};
HWY_INLINE Vec3s splat(vec3 v) { return {v.x, v.y, v.z}; }
HWY_INLINE Vec3s operator+(const Vec3s& a, const Vec3s& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
HWY_INLINE Vec3s operator-(const Vec3s& a, const Vec3s& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
HWY_INLINE Vec3s operator*(const Vec3s& a, const Floats& s) { return {a.x * s, a.y * s, a.z * s}; }
HWY_INLINE Vec3s operator*(const Vec3s& a, const Vec3s& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
HWY_INLINE Vec3s fma(const Vec3s& a, const Floats& s, const Vec3s& b) {
    return {fma(a.x, s, b.x), fma(a.y, s, b.y), fma(a.z, s, b.z)};
}
HWY_INLINE Floats dot(const Vec3s& a, const Vec3s& b) { return fma(a.z, b.z, fma(a.y, b.y, a.x * b.x)); }

// Affine matrix times points.
HWY_INLINE Vec3s transform_points(const mat4& m, const Vec3s& p) {
    return {fma(p.z, m[2].x, fma(p.y, m[1].x, fma(p.x, m[0].x, m[3].x))),
            fma(p.z, m[2].y, fma(p.y, m[1].y, fma(p.x, m[0].y, m[3].y))),
            fma(p.z, m[2].z, fma(p.y, m[1].z, fma(p.x, m[0].z, m[3].z)))};
}
}
HWY_AFTER_NAMESPACE();
#endif
