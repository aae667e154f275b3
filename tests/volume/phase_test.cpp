// Phase functions: normalized, of the mean cosine they claim, and the same in the vector kernels.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "volume/phase_test.cpp"
#include <hwy/foreach_target.h>

#include "volume/phase/phase_samples.h"
#include "volume/phase_simd.h"

#include <gtest/gtest.h>

HWY_BEFORE_NAMESPACE();
namespace tyndall::HWY_NAMESPACE {
namespace {
void phase_values(const Phase& phase, const float* cosine, float* value) {
    store(phase_value(phase, load(cosine)), value);
}
}
}
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tyndall {
namespace {
HWY_EXPORT(phase_values);

// Integrals over the sphere of p and of p·cosine: Gauss-Legendre pieces, fine towards the lobe.
struct Moments {
    double total = 0, cosine = 0;
};
Moments moments(Phase phase) {
    constexpr double node = 0.57735026918962576;
    constexpr int pieces = 4000;
    Moments sum;
    for (int i = 0; i < pieces; ++i) {
        const double low = pi * i / pieces, high = pi * (i + 1) / pieces;
        for (const double x : {-node, node}) {
            const double angle = (low + high) / 2 + x * (high - low) / 2;
            const double weight = std::sin(angle) * (high - low) / 2 * 2 * pi;
            const double value = phase_value(phase, static_cast<float>(std::cos(angle)));
            sum.total += weight * value, sum.cosine += weight * value * std::cos(angle);
        }
    }
    return sum;
}

TEST(Phase, IntegratesToOne) {
    for (int i = -99; i <= 99; i += 3) {
        const float g = static_cast<float>(i) / 100;
        const Moments m = moments({PhaseKind::henyey_greenstein, g});
        EXPECT_NEAR(m.total, 1, 1e-3) << g;
        EXPECT_NEAR(m.cosine, g, 1e-3) << g;
    }
    for (const float g : {-0.5f, -0.2f, 0.0f, 0.3f, traits_of(PhaseKind::schlick).max_g})
        EXPECT_NEAR(moments({PhaseKind::schlick, g}).total, 1, 1e-3) << g;
    EXPECT_NEAR(moments({PhaseKind::isotropic, 0.7f}).total, 1, 1e-3);
    EXPECT_NEAR(moments({PhaseKind::rayleigh, 0}).total, 1, 1e-3);
    EXPECT_NEAR(moments({PhaseKind::rayleigh, 0}).cosine, 0, 1e-6);
}

TEST(Phase, KnownValues) {
    const Phase half{PhaseKind::henyey_greenstein, 0.5f}, strong{PhaseKind::henyey_greenstein, 0.85f};
    EXPECT_NEAR(phase_value(half, 1), 0.4774648, 1e-6);
    EXPECT_NEAR(phase_value(half, 0), 0.0427058, 1e-7);
    EXPECT_NEAR(phase_value(half, -1), 0.0176839, 1e-7);
    EXPECT_NEAR(phase_value(strong, 1), 6.5430365, 1e-5);
    EXPECT_NEAR(phase_value(strong, -1), 0.0034877, 1e-7);
    EXPECT_NEAR(phase_value({PhaseKind::rayleigh, 0}, 1), 3 / (8 * pi), 1e-7);
}

// Forward over backward is ((1+g)/(1-g))³: the sign convention, too.
TEST(Phase, LooksBrighterIntoTheLight) {
    for (const float g : {0.1f, 0.5f, 0.9f}) {
        const Phase phase{PhaseKind::henyey_greenstein, g};
        const double ratio = double(phase_value(phase, 1)) / phase_value(phase, -1);
        EXPECT_NEAR(ratio / std::pow((1.0 + g) / (1.0 - g), 3), 1, 1e-4);
    }
}

TEST(Phase, VectorsEqualScalars) {
    for (const PhaseKind kind :
         {PhaseKind::isotropic, PhaseKind::henyey_greenstein, PhaseKind::schlick, PhaseKind::rayleigh})
        for (const float g : {-2.0f, -0.99f, -0.4f, 0.0f, 1e-4f, 0.3f, 0.49f, 0.9f, 0.99f, 1.0f}) {
            if (kind == PhaseKind::schlick && std::abs(g) > traits_of(kind).max_g) continue;
            for (int i = 0; i <= 64; ++i) {
                alignas(64) float cosine[16], value[16];
                for (int lane = 0; lane < 16; ++lane)
                    cosine[lane] = std::clamp(-1 + (i * 16 + lane) / 512.0f, -1.0f, 1.0f);
                HWY_DYNAMIC_DISPATCH(phase_values)({kind, g}, cosine, value);
                for (int lane = 0; lane < 16; ++lane) {
                    const float expected = phase_value({kind, g}, cosine[lane]);
                    EXPECT_NEAR(value[lane], expected, 1e-6 * expected) << int(kind) << ' ' << g << ' ' << cosine[lane];
                }
            }
        }
}

TEST(Phase, VectorsEqualScalarsOfShapes) {
    std::vector<test::NamedPhase> phases = test::shaped_phases();
    for (const test::NamedPhase& one : phases)
        for (int i = 0; i <= 64; ++i) {
            alignas(64) float cosine[16], value[16];
            for (int lane = 0; lane < 16; ++lane) { // fine towards both ends, and a little beyond
                const float u = (i * 16 + lane) / 512.0f - 1;
                cosine[lane] = std::copysign(1 - std::pow(1 - std::min(std::abs(u), 1.0f), 4.0f), u) * 1.000001f;
            }
            HWY_DYNAMIC_DISPATCH(phase_values)(one.phase, cosine, value);
            for (int lane = 0; lane < 16; ++lane) {
                const float expected = phase_value(one.phase, cosine[lane]);
                ASSERT_NEAR(value[lane], expected, 2e-6 * expected) << one.name << ' ' << cosine[lane];
            }
        }
    alignas(64) float none[16], value[16];
    std::fill_n(none, 16, std::nanf(""));
    HWY_DYNAMIC_DISPATCH(phase_values)(phases.back().phase, none, value); // reads within its table
}
}
}
#endif
