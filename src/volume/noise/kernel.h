// Gradient noise on one vector of points, compiled once per instruction set; included by kernel files only.
// Perlin, "Improving Noise" (2002), with gradients chosen by an integer hash instead of a permutation table.
#if defined(TYNDALL_VOLUME_NOISE_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_VOLUME_NOISE_KERNEL_H
#undef TYNDALL_VOLUME_NOISE_KERNEL_H
#else
#define TYNDALL_VOLUME_NOISE_KERNEL_H
#endif

#include "base/simd/simd.h"
#include "volume/noise/lattice.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
using FloatVec = hn::Vec<FloatTag>;
using IntVec = hn::Vec<IntTag>;

HWY_INLINE FloatVec splat(float value) { return hn::Set(FloatTag(), value); }
HWY_INLINE IntVec splat_int(uint32_t value) { return hn::Set(IntTag(), static_cast<int32_t>(value)); }

// Lattice coordinates of points along one axis: the fraction within the cell, and the hashed numbers of its two sides.
struct LatticeAxis {
    FloatVec fraction;
    IntVec low, high;
};

inline constexpr uint32_t axis_primes[3] = {501125321u, 1136930381u, 1720413743u};

// Converts cell numbers up to 2^22 to integers through the float mantissa, with one addition.
HWY_INLINE IntVec cell_number(FloatVec whole, int32_t base) {
    const IntVec bits = hn::BitCast(IntTag(), hn::Add(whole, splat(12582912.0f)));
    return hn::Add(bits, splat_int(static_cast<uint32_t>(base) - 0x4b400000u));
}

// Far from the origin the first product is off by fractions of a cell; the second subtracts the whole cells before
// rounding and stays accurate.
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

// The 16 gradients in registers, indexed by the upper four bits of a hash.
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

inline constexpr uint32_t hash_factor = 0x27d4eb2du;
HWY_INLINE IntVec corner_hash(IntVec xy, IntVec z) { return hn::Mul(hn::Xor(xy, z), splat_int(hash_factor)); }

// The gradient selected by a hash. If a register holds only eight of them, flip_by() must apply the sign.
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

// Interpolates the eight ramps of a cell with the faded fractions; corner_ramp(i, j, k, dx, dy, dz) returns one.
template<class CornerRamp>
HWY_INLINE FloatVec mixed_ramps(FloatVec x0, FloatVec y0, FloatVec z0, const CornerRamp& corner_ramp) {
    const FloatVec one = splat(1), x1 = hn::Sub(x0, one), y1 = hn::Sub(y0, one), z1 = hn::Sub(z0, one);
    const FloatVec tx = fade(x0), ty = fade(y0), tz = fade(z0);
    const auto edge = [&](int i, int j, FloatVec dx, FloatVec dy) {
        return lerp(corner_ramp(i, j, 0, dx, dy, z0), corner_ramp(i, j, 1, dx, dy, z1), tz);
    };
    return lerp(lerp(edge(0, 0, x0, y0), edge(0, 1, x0, y1), ty), lerp(edge(1, 0, x1, y0), edge(1, 1, x1, y1), ty), tx);
}

HWY_INLINE FloatVec noise_in_many_cells(const NoiseOctave& octave, const LatticeAxis& x, const LatticeAxis& y,
                                        const LatticeAxis& z) {
    const GradientTable table(octave);
    const IntVec seed = splat_int(octave.seed), x_hash[2] = {hn::Xor(x.low, seed), hn::Xor(x.high, seed)};
    const IntVec y_hash[2] = {y.low, y.high}, z_hash[2] = {z.low, z.high};
    return mixed_ramps(x.fraction, y.fraction, z.fraction,
                       [&](int i, int j, int k, FloatVec dx, FloatVec dy, FloatVec dz) {
                           const IntVec hash = corner_hash(hn::Xor(x_hash[i], y_hash[j]), z_hash[k]);
                           return ramp(table, hash, dx, dy, dz);
                       });
}

// All points lie in the cell with these hashed numbers, so its gradients are the same in every lane.
HWY_INLINE FloatVec noise_in_one_cell(const NoiseOctave& octave, FloatVec x, FloatVec y, FloatVec z, uint32_t x_low,
                                      uint32_t y_low, uint32_t z_low) {
    const uint32_t x_hash[2] = {x_low ^ octave.seed, (x_low + axis_primes[0]) ^ octave.seed};
    const uint32_t y_hash[2] = {y_low, y_low + axis_primes[1]}, z_hash[2] = {z_low, z_low + axis_primes[2]};
    return mixed_ramps(x, y, z, [&](int i, int j, int k, FloatVec dx, FloatVec dy, FloatVec dz) {
        const uint32_t entry = (x_hash[i] ^ y_hash[j] ^ z_hash[k]) * hash_factor >> 28;
        const FloatVec gx = splat(octave.gradient_x[entry]), gy = splat(octave.gradient_y[entry]);
        return hn::MulAdd(gx, dx, hn::MulAdd(gy, dy, hn::Mul(splat(octave.gradient_z[entry]), dz)));
    });
}

// The value of an octave, -√3/2..√3/2. Points often share one cell of a coarse octave, which is twice as fast.
HWY_INLINE FloatVec octave_noise(const NoiseOctave& octave, FloatVec px, FloatVec py, FloatVec pz) {
    const LatticeAxis x = lattice_axis(octave, 0, px), y = lattice_axis(octave, 1, py), z = lattice_axis(octave, 2, pz);
    const IntTag tag;
    const int32_t first[3] = {hn::GetLane(x.low), hn::GetLane(y.low), hn::GetLane(z.low)};
    const IntVec apart = hn::Or(hn::Or(hn::Xor(x.low, hn::Set(tag, first[0])), hn::Xor(y.low, hn::Set(tag, first[1]))),
                                hn::Xor(z.low, hn::Set(tag, first[2])));
    if (hn::AllTrue(tag, hn::Eq(apart, hn::Zero(tag))))
        return noise_in_one_cell(octave, x.fraction, y.fraction, z.fraction, static_cast<uint32_t>(first[0]),
                                 static_cast<uint32_t>(first[1]), static_cast<uint32_t>(first[2]));
    return noise_in_many_cells(octave, x, y, z);
}

// Adds an octave to a sum.
HWY_INLINE FloatVec add_octave(const NoiseOctave& octave, bool billow, FloatVec value, FloatVec sum) {
    return hn::MulAdd(splat(octave.scale), billow ? hn::Abs(value) : value, sum);
}
}
HWY_AFTER_NAMESPACE();
#endif
