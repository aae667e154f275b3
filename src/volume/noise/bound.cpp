#include "volume/noise/noise.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "volume/noise/bound.cpp"
#include <hwy/foreach_target.h>

#include "volume/noise/bound_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
// The largest bound of sixteen boxes.
float noise_bound_kernel(const NoiseSum& sum, const float (&low)[3][16], const float (&high)[3][16]) {
    const FloatTag tag;
    float bound = -infinity;
    for (size_t first = 0; first < 16; first += lane_step) {
        Boxes boxes;
        for (int axis = 0; axis < 3; ++axis)
            boxes.axis[axis] = {hn::LoadU(tag, low[axis] + first), hn::LoadU(tag, high[axis] + first)};
        bound = std::max(bound, hn::GetLane(hn::MaxOfLanes(tag, sum_bound(sum, boxes))));
    }
    return bound;
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
HWY_EXPORT(noise_bound_kernel);

float fractal_noise_bound(const FractalNoise& noise, float turn, const Box& box) {
    // Sixteen pieces give a tighter bound than the whole box; neighbors share faces, so there are no gaps.
    float low[3][16], high[3][16];
    constexpr int pieces[3] = {4, 2, 2};
    for (int i = 0; i < 16; ++i) {
        const int at[3] = {i % 4, i / 4 % 2, i / 8};
        for (int axis = 0; axis < 3; ++axis) {
            const auto face = [&](int n) {
                return n == pieces[axis] ? box.high[axis]
                                         : box.low[axis] + (box.high[axis] - box.low[axis]) * n / pieces[axis];
            };
            low[axis][i] = face(at[axis]), high[axis][i] = face(at[axis] + 1);
        }
    }
    const NoiseSum sum = noise_sum(noise, {{.turn = wrapped_turn(snapped_turn(turn))}}, dvec3(0));
    return HWY_DYNAMIC_DISPATCH(noise_bound_kernel)(sum, low, high);
}
}
#endif
