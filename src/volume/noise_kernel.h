// Gradient noise on one vector of points, compiled once per instruction set; included by kernel files only.
// Perlin, "Improving Noise" (2002), with gradients chosen by an integer hash instead of a permutation table.
#if defined(TYNDALL_VOLUME_NOISE_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_VOLUME_NOISE_KERNEL_H
#undef TYNDALL_VOLUME_NOISE_KERNEL_H
#else
#define TYNDALL_VOLUME_NOISE_KERNEL_H
#endif

#include "base/simd.h"
#include "volume/noise_lattice.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
using FloatVec = hn::Vec<FloatTag>;
using IntVec = hn::Vec<IntTag>;

HWY_INLINE FloatVec splat(float value) { return hn::Set(FloatTag(), value); }
HWY_INLINE IntVec splat_int(uint32_t value) { return hn::Set(IntTag(), static_cast<int32_t>(value)); }

// Where points lie along one axis of a lattice: the fraction within the cell, and the hashed cell numbers of both
// sides.
struct LatticeAxis {
    FloatVec fraction;
    IntVec low, high;
};

inline constexpr uint32_t axis_primes[3] = {501125321u, 1136930381u, 1720413743u};

// Cell numbers up to 2^22 become integers by the mantissa of a float: one addition.
HWY_INLINE IntVec cell_number(FloatVec whole, int32_t base) {
    const IntVec bits = hn::BitCast(IntTag(), hn::Add(whole, splat(12582912.0f)));
    return hn::Add(bits, splat_int(static_cast<uint32_t>(base) - 0x4b400000u));
}

// Far from the origin the first product is off by parts of a cell: the second, freed of whole cells, is not.
HWY_INLINE LatticeAxis lattice_axis(const NoiseOctave& octave, int axis, FloatVec x) {
    const FloatVec frequency = splat(octave.frequency), base = splat(octave.fraction[axis]);
    const FloatVec near = hn::Floor(hn::MulAdd(x, frequency, base));
    const FloatVec within = hn::Add(hn::MulSub(x, frequency, near), base), carry = hn::Floor(within);
    LatticeAxis result;
    result.fraction = hn::Sub(within, carry);
    result.low = hn::Mul(cell_number(hn::Add(near, carry), octave.cell[axis]), splat_int(axis_primes[axis]));
    result.high = hn::Add(result.low, splat_int(axis_primes[axis]));
    return result;
}

// 6t^5 - 15t^4 + 10t^3
HWY_INLINE FloatVec fade(FloatVec t) {
    const FloatVec p = hn::MulAdd(t, hn::MulAdd(t, splat(6), splat(-15)), splat(10));
    return hn::Mul(hn::Mul(hn::Mul(t, t), t), p);
}
HWY_INLINE FloatVec fade_slope(FloatVec t) { // 30t²(t - 1)²
    const FloatVec p = hn::Mul(t, hn::Sub(t, splat(1)));
    return hn::Mul(hn::Mul(p, p), splat(30));
}
HWY_INLINE FloatVec lerp(FloatVec a, FloatVec b, FloatVec t) { return hn::MulAdd(t, hn::Sub(b, a), a); }

// The 16 gradients in registers, looked up by the upper four bits of a hash.
struct GradientTable {
    const NoiseOctave& octave;
    FloatVec x, y, z;

    explicit HWY_INLINE GradientTable(const NoiseOctave& from)
        : octave(from), x(hn::LoadU(FloatTag(), from.gradient_x.data())),
          y(hn::LoadU(FloatTag(), from.gradient_y.data())), z(hn::LoadU(FloatTag(), from.gradient_z.data())) {}
};
struct Gradient {
    FloatVec x, y, z;
};

HWY_INLINE IntVec corner_hash(IntVec xy, IntVec z) { return hn::Mul(hn::Xor(xy, z), splat_int(0x27d4eb2du)); }

// The gradient a hash chooses; where a register holds only eight of them, without the sign that flip_by() adds.
HWY_INLINE Gradient gradient(const GradientTable& table, IntVec hash) {
    const hn::RebindToUnsigned<IntTag> bits;
    const auto entry = hn::ShiftRight<28>(hn::BitCast(bits, hash));
    if constexpr (lane_step >= 8) {
        const auto index =
            hn::IndicesFromVec(FloatTag(), lane_step >= 16 ? entry : hn::And(entry, hn::Set(bits, lane_step - 1)));
        return {hn::TableLookupLanes(table.x, index), hn::TableLookupLanes(table.y, index),
                hn::TableLookupLanes(table.z, index)};
    } else {
        const IntVec index = hn::BitCast(IntTag(), entry);
        return {hn::GatherIndex(FloatTag(), table.octave.gradient_x.data(), index),
                hn::GatherIndex(FloatTag(), table.octave.gradient_y.data(), index),
                hn::GatherIndex(FloatTag(), table.octave.gradient_z.data(), index)};
    }
}
HWY_INLINE FloatVec flip_by(IntVec hash, FloatVec value) {
    if constexpr (lane_step != 8) return value;
    return hn::Xor(value, hn::BitCast(FloatTag(), hn::And(hash, splat_int(0x80000000u))));
}

// gradient · (point - corner)
HWY_INLINE FloatVec ramp(const GradientTable& table, IntVec hash, FloatVec x, FloatVec y, FloatVec z) {
    const Gradient g = gradient(table, hash);
    return flip_by(hash, hn::MulAdd(g.x, x, hn::MulAdd(g.y, y, hn::Mul(g.z, z))));
}

// The value of an octave, -√3/2..√3/2.
HWY_INLINE FloatVec gradient_noise(const NoiseOctave& octave, const LatticeAxis& x, const LatticeAxis& y,
                                   const LatticeAxis& z) {
    const GradientTable table(octave);
    const FloatVec x0 = x.fraction, y0 = y.fraction, z0 = z.fraction, one = splat(1);
    const FloatVec x1 = hn::Sub(x0, one), y1 = hn::Sub(y0, one), z1 = hn::Sub(z0, one);
    const FloatVec tx = fade(x0), ty = fade(y0), tz = fade(z0);
    const IntVec seed = splat_int(octave.seed), low = hn::Xor(x.low, seed), high = hn::Xor(x.high, seed);
    const auto edge = [&](IntVec xy, FloatVec dx, FloatVec dy) {
        return lerp(ramp(table, corner_hash(xy, z.low), dx, dy, z0), ramp(table, corner_hash(xy, z.high), dx, dy, z1),
                    tz);
    };
    const FloatVec a = lerp(edge(hn::Xor(low, y.low), x0, y0), edge(hn::Xor(low, y.high), x0, y1), ty);
    const FloatVec b = lerp(edge(hn::Xor(high, y.low), x1, y0), edge(hn::Xor(high, y.high), x1, y1), ty);
    return lerp(a, b, tx);
}

// Adds an octave to a sum.
HWY_INLINE FloatVec add_octave(const NoiseOctave& octave, bool billow, FloatVec value, FloatVec sum) {
    return hn::MulAdd(splat(octave.scale), billow ? hn::Abs(value) : value, sum);
}
HWY_INLINE FloatVec octave_noise(const NoiseOctave& octave, FloatVec x, FloatVec y, FloatVec z) {
    return gradient_noise(octave, lattice_axis(octave, 0, x), lattice_axis(octave, 1, y), lattice_axis(octave, 2, z));
}
}
HWY_AFTER_NAMESPACE();
#endif
