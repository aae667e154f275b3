#include "volume/noise/noise.h"

#include <cassert>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "volume/noise/noise.cpp"
#include <hwy/foreach_target.h>

#include "volume/noise/kernel.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
void fractal_noise_kernel(const NoiseSum& sum, size_t count, const float* x, const float* y, const float* z,
                          float* values) {
    const FloatTag tag;
    for (size_t first = 0; first < count; first += lane_step) {
        const size_t left = count - first;
        const auto point = [&](const float* from) {
            return left < lane_step ? hn::MaskedLoad(hn::FirstN(tag, left), tag, from + first)
                                    : hn::LoadU(tag, from + first);
        };
        const FloatVec px = point(x), py = point(y), pz = point(z);
        FloatVec total = splat(sum.start);
        for (const NoiseOctave& octave : sum.octaves)
            total = add_octave(octave, sum.billow, octave_noise(octave, px, py, pz), total);
        if (left < lane_step)
            hn::BlendedStore(total, hn::FirstN(tag, left), tag, values + first);
        else
            hn::StoreU(total, tag, values + first);
    }
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
HWY_EXPORT(fractal_noise_kernel);

void fractal_noise(const FractalNoise& noise, float turn, std::span<const float> x, std::span<const float> y,
                   std::span<const float> z, std::span<float> values) {
    assert(x.size() == values.size() && y.size() == values.size() && z.size() == values.size());
    const NoiseSum sum = noise_sum(noise, {{.turn = wrapped_turn(snapped_turn(turn))}}, dvec3(0));
    HWY_DYNAMIC_DISPATCH(fractal_noise_kernel)(sum, values.size(), x.data(), y.data(), z.data(), values.data());
}
}
#endif
