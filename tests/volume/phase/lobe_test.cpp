// Lobes of Draine's form and Mie's by them: sums, means, known cases, and directions that follow them.
#include "base/random.h"
#include "volume/phase/mie.h"
#include "volume/phase/phase_samples.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
TEST(PhaseShapes, IntegrateToOneAndHaveTheirMeanCosine) {
    for (const NamedPhase& one : shaped_phases()) {
        const auto value = [&](double c) { return phase_value_of<double>(one.phase, c); };
        const bool table = one.phase.shape->lobes.empty(); // has kinks
        EXPECT_NEAR(over_sphere(value), 1, table ? 1e-5 : 1e-7) << one.name;
        EXPECT_NEAR(over_sphere([&](double c) { return c * value(c); }), mean_cosine(one.phase), table ? 1e-5 : 1e-7)
            << one.name;
    }
}

TEST(PhaseShapes, FloatsAreTheDoublesRounded) {
    for (const NamedPhase& one : shaped_phases())
        for (int i = -100; i <= 100; ++i) {
            const float c = 0.01f * static_cast<float>(i);
            const double expected = phase_value_of<double>(one.phase, c);
            ASSERT_NEAR(phase_value(one.phase, c) / expected, 1, 2e-5) << one.name << " " << c;
        }
}

TEST(PhaseShapes, SharesOfTheLightAreTheirIntegrals) {
    for (const NamedPhase& one : shaped_phases()) {
        const auto value = [&](double c) { return 2 * std::numbers::pi * phase_value_of<double>(one.phase, c); };
        for (const double c : {-0.999, -0.7, 0.0, 0.4, 0.95}) {
            const double below = over_sphere([&](double x) { return x < c ? value(x) / (2 * std::numbers::pi) : 0; });
            EXPECT_NEAR(cosine_cdf(*one.phase.shape, c), below, 2e-3)
                << one.name << " " << c; // a step in the integrand
        }
        EXPECT_NEAR(cosine_cdf(*one.phase.shape, -1), 0, 1e-6) << one.name;
        EXPECT_NEAR(cosine_cdf(*one.phase.shape, 1), 1, 1e-6) << one.name;
        // Its slope is the value, seen where nothing has a kink.
        const bool table = one.phase.shape->lobes.empty();
        for (const double c : {-0.8, -0.3, 0.1, 0.6}) {
            const double slope =
                (cosine_cdf(*one.phase.shape, c + 1e-3) - cosine_cdf(*one.phase.shape, c - 1e-3)) / 2e-3;
            EXPECT_NEAR(slope / value(c), 1, table ? 2e-3 : 2e-4) << one.name << " " << c;
        }
    }
}

TEST(PhaseShapes, CosinesAreTheInversesOfTheirShares) {
    for (const NamedPhase& one : shaped_phases()) {
        // Lobes are picked one by one: only a single one gives cosines in order.
        const PhaseShape& shape = *one.phase.shape;
        if (shape.lobes.size() > 1) continue;
        double before = -1;
        for (int i = 0; i <= 1000; ++i) {
            const double u = i / 1000.0, c = sampled_cosine(shape, u);
            ASSERT_GE(c, before - 1e-12) << one.name << " " << u;
            ASSERT_NEAR(cosine_cdf(shape, c), u, 1e-7) << one.name << " " << u;
            before = c;
        }
    }
}

// Pearson's chi-square over bins of equal probability, angles measured where cosines have lost them.
TEST(PhaseShapes, DirectionsFollowTheValues) {
    constexpr int samples = 30000, bins = 40;
    const vec3 axis = glm::normalize(vec3(0.3f, -0.5f, 0.8f));
    vec3 x, y;
    make_frame(axis, x, y);
    for (const NamedPhase& one : shaped_phases()) {
        int counts[bins] = {}, turns[bins] = {};
        for (uint32_t i = 0; i < samples; ++i) {
            const vec3 direction = sample_phase(one.phase, axis, {random_unit(i, 0, 0, 5), random_unit(i, 0, 1, 5)});
            ASSERT_NEAR(glm::length(direction), 1, 1e-5) << one.name;
            const dvec3 d(direction), a(axis);
            const double cosine = std::cos(std::atan2(glm::length(glm::cross(a, d)), glm::dot(a, d)));
            const double share = cosine_cdf(*one.phase.shape, cosine);
            ++counts[std::clamp(static_cast<int>(share * bins), 0, bins - 1)];
            const double turn =
                std::atan2(glm::dot(direction, y), glm::dot(direction, x)) / (2 * std::numbers::pi) + 0.5;
            ++turns[std::clamp(static_cast<int>(turn * bins), 0, bins - 1)];
        }
        double chi_cosine = 0, chi_turn = 0;
        constexpr double expected = static_cast<double>(samples) / bins;
        for (int b = 0; b < bins; ++b) {
            chi_cosine += std::pow(counts[b] - expected, 2) / expected;
            chi_turn += std::pow(turns[b] - expected, 2) / expected;
        }
        // 39 degrees of freedom: mean 39, standard deviation 8.8; 85 has a chance of 3e-5, in some hundred tries.
        EXPECT_LT(chi_cosine, 85) << one.name;
        EXPECT_LT(chi_turn, 85) << one.name;
    }
}

TEST(PhaseShapes, DraineHoldsTheKnownFormsInIt) {
    for (const double c : {-1.0, -0.5, 0.0, 0.3, 1.0}) {
        EXPECT_NEAR(phase_value_of<double>(draine_phase(0, 1), c), 3 / (16 * std::numbers::pi) * (1 + c * c), 1e-12);
        EXPECT_NEAR(phase_value_of<double>(draine_phase(0.75, 0), c) /
                        phase_value_of<double>({PhaseKind::henyey_greenstein, 0.75f}, c),
                    1, 1e-6);
    }
    // Cornette and Shanks 1992, equations 6 and 7.
    for (const double g : {-0.7, 0.2, 0.85}) {
        EXPECT_NEAR(mean_cosine(draine_phase(g, 1)), g * 3 * (4 + g * g) / (5 * (2 + g * g)), 1e-6);
        const double c = 0.3, expected = 3 / (8 * std::numbers::pi) * (1 - g * g) / (2 + g * g) * (1 + c * c) /
                                         std::pow(1 + g * g - 2 * g * c, 1.5);
        EXPECT_NEAR(phase_value_of<double>(draine_phase(g, 1), c), expected, 1e-12);
    }
}

TEST(PhaseShapes, MixturesAreSumsOfTheirParts) {
    const Phase droplets = mie_phase(12), back{PhaseKind::henyey_greenstein, -0.4f};
    const Phase mixed = mixed_phase(0.3, droplets, back);
    for (const double c : {-1.0, -0.2, 0.5, 0.999, 1.0})
        EXPECT_NEAR(phase_value_of<double>(mixed, c) /
                        (0.3 * phase_value_of<double>(droplets, c) + 0.7 * phase_value_of<double>(back, c)),
                    1, 1e-6);
    EXPECT_NEAR(mean_cosine(mixed), 0.3 * mean_cosine(droplets) + 0.7 * mean_cosine(back), 1e-6);
    EXPECT_EQ(mixed_phase(0, droplets, back).shape->lobes.size(), 1u);
}

TEST(PhaseShapes, NoValueFallsBelowTheLeast) {
    for (const NamedPhase& one : shaped_phases()) {
        double least = infinity;
        for (int i = -20000; i <= 20000; ++i) least = std::min(least, phase_value_of<double>(one.phase, i / 20000.0));
        EXPECT_LE(min_phase_value(one.phase), least * (1 + 1e-9)) << one.name;
        EXPECT_GE(min_phase_value(one.phase), 0.85 * least) << one.name;
    }
}

// The fit's numbers worked out apart from the program, to six digits, from the equations as printed.
TEST(Mie, IsTheFitAsPublished) {
    const struct {
        double d, g, draine_g, alpha, weight;
    } rows[] = {
        {0.05, 0.0345, 0.025661182, 250, 0.25218067},        {0.1, 0.138, 0.091768064, 250, 0.23729069},
        {0.3, 0.65471428, 0.67745774, 250, 0.16600123},      {1, 0.862, 0.50691618, 250, 0.24075857},
        {2, 0.9180845, 0.38748989, 11.379178, 0.41206804},   {4, 0.96001512, 0.47935916, 16.441606, 0.41704406},
        {5, 0.97067796, 0.50834162, 17.068098, 0.44782949},  {10, 0.98817669, 0.55567125, 21.995521, 0.48195543},
        {20, 0.99461005, 0.59379058, 27.113694, 0.49815948}, {50, 0.99795244, 0.62508447, 32.315428, 0.50761832},
        {1.5, 0.88564764, 0.40946865, 9.2780806, 0.37241761}};
    for (const auto& row : rows) {
        const MieFit fit = mie_fit(row.d);
        EXPECT_NEAR(fit.g, row.g, 1e-6) << row.d;
        EXPECT_NEAR(fit.draine_g, row.draine_g, 1e-6) << row.d;
        EXPECT_NEAR(fit.draine_alpha / row.alpha, 1, 1e-6) << row.d;
        EXPECT_NEAR(fit.draine_weight, row.weight, 1e-6) << row.d;
    }
}

TEST(Mie, IsAPhaseFunctionOverItsWholeRange) {
    for (double d = 1e-3; d <= largest_droplet; d *= 1.01) {
        const MieFit fit = mie_fit(d);
        ASSERT_TRUE(fit.draine_weight > 0 && fit.draine_weight < 1) << d;
        ASSERT_TRUE(std::abs(fit.g) < 1 && std::abs(fit.draine_g) < 1 && fit.draine_alpha > 0) << d;
    }
}

// Cloud droplets in visible light have a mean cosine of 0.85 to 0.88 (Hu & Stamnes 1993, effective radii of 5 to 30
// micrometers); those far smaller than the wavelength scatter as Rayleigh says.
TEST(Mie, HasTheMeanCosineOfCloudsAndOfAir) {
    for (const double d : {10.0, 15.0, 20.0, 30.0, 50.0}) {
        EXPECT_GT(mean_cosine(mie_phase(d)), 0.82) << d;
        EXPECT_LT(mean_cosine(mie_phase(d)), 0.90) << d;
    }
    for (const double c : {-1.0, 0.0, 1.0})
        EXPECT_NEAR(phase_value_of<double>(mie_phase(0.002), c) / phase_value_of<double>({PhaseKind::rayleigh}, c), 1,
                    0.02);
}
}
}
