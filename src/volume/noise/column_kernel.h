// An octave along a column of points that differ only in x: terms in y and z are computed once for all points,
// gradients once per cell. Bit-identical to octave_noise(). Included by kernel files only.
#if defined(TYNDALL_VOLUME_NOISE_COLUMN_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_VOLUME_NOISE_COLUMN_KERNEL_H
#undef TYNDALL_VOLUME_NOISE_COLUMN_KERNEL_H
#else
#define TYNDALL_VOLUME_NOISE_COLUMN_KERNEL_H
#endif

#include "volume/noise/kernel.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
class OctaveColumn {
public:
    HWY_INLINE OctaveColumn(const NoiseOctave& octave, FloatVec y, FloatVec z)
        : octave_(octave), y_(lattice_axis(octave, 1, y)), z_(lattice_axis(octave, 2, z)), fade_y_(fade(y_.fraction)),
          fade_z_(fade(z_.fraction)) {
        const IntTag tag;
        const IntVec apart = hn::Or(hn::Xor(y_.low, hn::Set(tag, hn::GetLane(y_.low))),
                                    hn::Xor(z_.low, hn::Set(tag, hn::GetLane(z_.low))));
        one_cell_ = hn::AllTrue(tag, hn::Eq(apart, hn::Zero(tag)));
    }

    HWY_INLINE FloatVec at(float x) {
        const LatticeAxis axis = lattice_axis(octave_, 0, splat(x));
        const int32_t cell = hn::GetLane(axis.low);
        if (!entered_ || cell != cell_) one_cell_ ? enter_one_cell(cell) : enter_cells(axis);
        entered_ = true, cell_ = cell;

        const FloatVec x0 = axis.fraction, x1 = hn::Sub(x0, splat(1));
        const auto ramp = [&](int corner) {
            const FloatVec value = hn::MulAdd(along_x_[corner], corner & 4 ? x1 : x0, across_[corner]);
            return one_cell_ ? value : flip_by(hash_[corner], value);
        };
        const auto edge = [&](int corner) { return lerp(ramp(corner), ramp(corner + 1), fade_z_); };
        return lerp(lerp(edge(0), edge(2), fade_y_), lerp(edge(4), edge(6), fade_y_), fade(x0));
    }

private:
    // Sets the terms of corner 4·i + 2·j + k: the factor of x, and the sum of the products with y and z.
    HWY_INLINE void set_corner(int corner, FloatVec gx, FloatVec gy, FloatVec gz) {
        const FloatVec one = splat(1);
        const FloatVec y = corner & 2 ? hn::Sub(y_.fraction, one) : y_.fraction;
        const FloatVec z = corner & 1 ? hn::Sub(z_.fraction, one) : z_.fraction;
        along_x_[corner] = gx, across_[corner] = hn::MulAdd(gy, y, hn::Mul(gz, z));
    }

    HWY_INLINE void enter_one_cell(int32_t cell) {
        const uint32_t low[3] = {static_cast<uint32_t>(cell), static_cast<uint32_t>(hn::GetLane(y_.low)),
                                 static_cast<uint32_t>(hn::GetLane(z_.low))};
        for (int corner = 0; corner < 8; ++corner) {
            uint32_t hash = octave_.seed;
            for (int axis = 0; axis < 3; ++axis) hash ^= low[axis] + (corner >> (2 - axis) & 1) * axis_primes[axis];
            const uint32_t entry = hash * hash_factor >> 28;
            set_corner(corner, splat(octave_.gradient_x[entry]), splat(octave_.gradient_y[entry]),
                       splat(octave_.gradient_z[entry]));
        }
    }

    HWY_INLINE void enter_cells(const LatticeAxis& x) {
        const GradientTable table(octave_);
        const IntVec seed = splat_int(octave_.seed);
        for (int corner = 0; corner < 8; ++corner) {
            const IntVec x_hash = hn::Xor(corner & 4 ? x.high : x.low, seed);
            const IntVec xy = hn::Xor(x_hash, corner & 2 ? y_.high : y_.low);
            hash_[corner] = corner_hash(xy, corner & 1 ? z_.high : z_.low);
            const Gradient g = gradient(table, hash_[corner]);
            set_corner(corner, g.x, g.y, g.z);
        }
    }

    const NoiseOctave& octave_;
    LatticeAxis y_, z_;
    FloatVec fade_y_, fade_z_, along_x_[8], across_[8];
    IntVec hash_[8];
    int32_t cell_ = 0;
    bool one_cell_ = false, entered_ = false;
};
}
HWY_AFTER_NAMESPACE();
#endif
