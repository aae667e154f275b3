// Curl of a vector potential of three gradient noises: a divergence-free field that stirs coordinates (Bridson,
// Hourihan and Nordenstam, "Curl-Noise for Procedural Fluid Flow", 2007); included by kernel files only.
#if defined(TYNDALL_VOLUME_NOISE_CURL_KERNEL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TYNDALL_VOLUME_NOISE_CURL_KERNEL_H
#undef TYNDALL_VOLUME_NOISE_CURL_KERNEL_H
#else
#define TYNDALL_VOLUME_NOISE_CURL_KERNEL_H
#endif

#include "volume/noise/kernel.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
struct FloatVec3 {
    FloatVec x, y, z;
};

// Weights of a cell's corners along one axis, and their derivatives.
struct AxisWeights {
    FloatVec offset[2], weight[2], slope[2];

    explicit HWY_INLINE AxisWeights(FloatVec t)
        : offset{t, hn::Sub(t, splat(1))}, weight{hn::Sub(splat(1), fade(t)), fade(t)}, slope{hn::Neg(fade_slope(t)),
                                                                                              fade_slope(t)} {}
};

// Curl per cell (not per meter) at points. The three potentials share the lattice but use different bits of its hash.
HWY_INLINE FloatVec3 noise_curl(const NoiseOctave& octave, FloatVec px, FloatVec py, FloatVec pz) {
    const GradientTable table(octave);
    const LatticeAxis lx = lattice_axis(octave, 0, px), ly = lattice_axis(octave, 1, py),
                      lz = lattice_axis(octave, 2, pz);
    const AxisWeights x(lx.fraction), y(ly.fraction), z(lz.fraction);
    FloatVec3 curl{splat(0), splat(0), splat(0)};
    const auto add_corner = [&](int i, int j, int k) {
        const IntVec seed = splat_int(octave.seed);
        const IntVec xy = hn::Xor(hn::Xor(i ? lx.high : lx.low, seed), j ? ly.high : ly.low);
        const IntVec hash = corner_hash(xy, k ? lz.high : lz.low);
        // Product rule: (weight · ramp)' = weight · gradient + weight' · ramp.
        const FloatVec dx = hn::Mul(hn::Mul(x.slope[i], y.weight[j]), z.weight[k]);
        const FloatVec dy = hn::Mul(hn::Mul(x.weight[i], y.slope[j]), z.weight[k]);
        const FloatVec dz = hn::Mul(hn::Mul(x.weight[i], y.weight[j]), z.slope[k]);
        const FloatVec weight = hn::Mul(hn::Mul(x.weight[i], y.weight[j]), z.weight[k]);
        const auto potential = [&](IntVec bits, auto&& add) {
            const Gradient g = gradient(table, bits);
            const FloatVec r = hn::MulAdd(g.x, x.offset[i], hn::MulAdd(g.y, y.offset[j], hn::Mul(g.z, z.offset[k])));
            const auto slope = [&](FloatVec component, FloatVec weight_slope) {
                return flip_by(bits, hn::MulAdd(weight, component, hn::Mul(weight_slope, r)));
            };
            add(g, slope);
        };
        potential(hash, [&](const Gradient& g, auto&& slope) {
            curl.y = hn::Add(curl.y, slope(g.z, dz)), curl.z = hn::Sub(curl.z, slope(g.y, dy));
        });
        potential(hn::ShiftLeft<4>(hash), [&](const Gradient& g, auto&& slope) {
            curl.z = hn::Add(curl.z, slope(g.x, dx)), curl.x = hn::Sub(curl.x, slope(g.z, dz));
        });
        potential(hn::ShiftLeft<8>(hash), [&](const Gradient& g, auto&& slope) {
            curl.x = hn::Add(curl.x, slope(g.y, dy)), curl.y = hn::Sub(curl.y, slope(g.x, dx));
        });
    };
    for (int corner = 0; corner < 8; ++corner) add_corner(corner & 1, corner >> 1 & 1, corner >> 2);
    return curl;
}
}
HWY_AFTER_NAMESPACE();
#endif
