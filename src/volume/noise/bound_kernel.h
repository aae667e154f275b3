// Conservative bounds of gradient noise over boxes, one box per lane; included by kernel files only.
#if defined(TYNDALL_VOLUME_NOISE_BOUND_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_VOLUME_NOISE_BOUND_KERNEL_H
#undef TYNDALL_VOLUME_NOISE_BOUND_KERNEL_H
#else
#define TYNDALL_VOLUME_NOISE_BOUND_KERNEL_H
#endif

#include "volume/noise/kernel.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
struct Range {
    FloatVec low, high;
};
struct Boxes {
    Range axis[3]; // meters
};

// An interval along one axis, split into the (at most two) cells it touches. Rounding is monotonic, so the cell and
// fraction of any point inside lie between those of the ends.
struct CellStretch {
    LatticeAxis ends[2];
    Range fraction[2], faded[2];
    bool two = false;        // at least one lane touches two cells
    hn::Mask<FloatTag> wide; // lanes that touch more than two
};

HWY_INLINE CellStretch cell_stretch(const NoiseOctave& octave, int axis, const Range& x) {
    const FloatTag tag;
    CellStretch s;
    s.ends[0] = lattice_axis(octave, axis, x.low), s.ends[1] = lattice_axis(octave, axis, x.high);
    const auto same = hn::RebindMask(tag, hn::Eq(s.ends[0].low, s.ends[1].low));
    const auto next = hn::RebindMask(tag, hn::Eq(s.ends[0].high, s.ends[1].low));
    // Cell numbers wrap after 2^32 cells, so equal numbers are not enough: check the width as well.
    const auto longer = hn::Gt(hn::Mul(hn::Sub(x.high, x.low), splat(octave.frequency)), splat(2.5f));
    s.wide = hn::Or(longer, hn::Not(hn::Or(same, next)));
    s.two = !hn::AllTrue(tag, same);
    s.fraction[0] = {s.ends[0].fraction, hn::IfThenElse(same, s.ends[1].fraction, splat(1))};
    s.fraction[1] = {hn::IfThenElse(same, s.ends[0].fraction, splat(0)), s.ends[1].fraction};
    for (int i = 0; i < 2; ++i) s.faded[i] = {fade(s.fraction[i].low), fade(s.fraction[i].high)};
    return s;
}

// Range of a·x for x in low..high.
HWY_INLINE Range scaled(FloatVec a, FloatVec low, FloatVec high) {
    const FloatVec p = hn::Mul(a, low), q = hn::Mul(a, high);
    return {hn::Min(p, q), hn::Max(p, q)};
}
// Range of a linear interpolation: it is linear in the weight, so the extremes are at the ends of the weight's range.
HWY_INLINE Range lerp(const Range& a, const Range& b, const Range& weight) {
    return {hn::Min(lerp(a.low, b.low, weight.low), lerp(a.low, b.low, weight.high)),
            hn::Max(lerp(a.high, b.high, weight.low), lerp(a.high, b.high, weight.high))};
}

struct StretchPart {
    const CellStretch& stretch;
    int part;

    HWY_INLINE IntVec hash(int side) const { return side ? stretch.ends[part].high : stretch.ends[part].low; }
    HWY_INLINE Range offset(int side) const {
        const Range& f = stretch.fraction[part];
        return side ? Range{hn::Sub(f.low, splat(1)), hn::Sub(f.high, splat(1))} : f;
    }
    HWY_INLINE const Range& weight() const { return stretch.faded[part]; }
};

// Range of the noise within one cell: every corner's ramp takes its extremes at corners of the box; the ranges of the
// ramps are then interpolated.
HWY_INLINE Range cell_range(const GradientTable& table, const StretchPart& x, const StretchPart& y,
                            const StretchPart& z) {
    const IntVec seed = splat_int(table.octave.seed);
    const auto corner = [&](int i, int j, int k) {
        const IntVec hash = corner_hash(hn::Xor(hn::Xor(x.hash(i), seed), y.hash(j)), z.hash(k));
        const Gradient g = gradient(table, hash);
        const Range dx = x.offset(i), dy = y.offset(j), dz = z.offset(k);
        const Range a = scaled(flip_by(hash, g.x), dx.low, dx.high), b = scaled(flip_by(hash, g.y), dy.low, dy.high);
        const Range c = scaled(flip_by(hash, g.z), dz.low, dz.high);
        return Range{hn::Add(hn::Add(a.low, b.low), c.low), hn::Add(hn::Add(a.high, b.high), c.high)};
    };
    const auto side = [&](int i) {
        return lerp(lerp(corner(i, 0, 0), corner(i, 0, 1), z.weight()),
                    lerp(corner(i, 1, 0), corner(i, 1, 1), z.weight()), y.weight());
    };
    return lerp(side(0), side(1), x.weight());
}

// Range of an octave in each box, with a margin for rounding.
HWY_INLINE Range octave_range(const NoiseOctave& octave, const Boxes& boxes) {
    const FloatTag tag;
    const Range most{splat(-noise_peak), splat(noise_peak)};
    const CellStretch x = cell_stretch(octave, 0, boxes.axis[0]), y = cell_stretch(octave, 1, boxes.axis[1]),
                      z = cell_stretch(octave, 2, boxes.axis[2]);
    const auto wide = hn::Or(hn::Or(x.wide, y.wide), z.wide);
    if (hn::AllTrue(tag, wide)) return most;

    const GradientTable table(octave);
    Range range{splat(noise_peak), splat(-noise_peak)};
    for (int i = 0; i <= x.two; ++i)
        for (int j = 0; j <= y.two; ++j)
            for (int k = 0; k <= z.two; ++k) {
                const Range cell = cell_range(table, {x, i}, {y, j}, {z, k});
                range = {hn::Min(range.low, cell.low), hn::Max(range.high, cell.high)};
            }
    const FloatVec rounding = splat(1e-5f);
    return {hn::IfThenElse(wide, most.low, hn::Max(most.low, hn::Sub(range.low, rounding))),
            hn::IfThenElse(wide, most.high, hn::Min(most.high, hn::Add(range.high, rounding)))};
}

// Upper bound of the whole sum in each box.
HWY_INLINE FloatVec sum_bound(const NoiseSum& sum, const Boxes& boxes) {
    FloatVec total = splat(sum.start + 1e-5f);
    for (const NoiseOctave& octave : sum.octaves) {
        const Range range = octave_range(octave, boxes);
        const FloatVec highest = sum.billow ? hn::Max(range.high, hn::Neg(range.low)) : range.high;
        total = hn::MulAdd(splat(octave.scale), highest, total);
    }
    return total;
}
}
HWY_AFTER_NAMESPACE();
#endif
