// Places of equal angle in the vector kernels: those of the double-precision formulas, however wide the stretch is.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "integrate/equi_angular_test.cpp"
#include <hwy/foreach_target.h>

#include "integrate/equi_angular_simd.h"

#include <gtest/gtest.h>

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
void places(float low, float high, float height, const float* share, float* at) {
    const EquiAngular16 angles({Floats(low), Floats(high)}, Floats(height));
    store(angles.slope(load(share)) * height, at);
}
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "integrate/equi_angular.h"

namespace tyndall {
namespace {
HWY_EXPORT(places);

TEST(EquiAngular, KernelsFindThePlacesOfTheFormula) {
    struct Case {
        float low, high, height;
    };
    for (const Case& s : {Case{0.2f, 3, 0.5f}, Case{-2, -0.1f, 0.3f}, Case{-4, 5, 0.01f}, // almost 180°
                          Case{-0.01f, 5, 0.001f}, Case{-3, 0.002f, 0.01f}}) {
        alignas(64) float share[16], at[16];
        for (int i = 0; i < 16; ++i) share[i] = (static_cast<float>(i) + 0.5f) / 16;
        HWY_DYNAMIC_DISPATCH(places)(s.low, s.high, s.height, share, at);
        const EquiAngular<double> angles = equi_angular<double>(0, s.height, s.low, s.high);
        for (int i = 0; i < 16; ++i) {
            const double exact = angles.at(share[i]).t;
            EXPECT_NEAR(at[i], exact, 1e-5 * (std::abs(exact) + s.height)) << s.low << ' ' << s.high << ' ' << i;
        }
    }
}
}
}
#endif
