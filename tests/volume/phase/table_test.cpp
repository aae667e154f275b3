// Phase functions given by numbers.
#include "volume/phase/phase_samples.h"

#include <gtest/gtest.h>

namespace tyndall::test {
namespace {
double henyey_greenstein(double g, double c) {
    return (1 - g * g) / (4 * std::numbers::pi * std::pow(1 + g * g - 2 * g * c, 1.5));
}

TEST(PhaseTable, HoldsItsEntries) {
    const std::vector<PhaseEntry> entries{{0, 9}, {30, 3}, {90, 1}, {150, 0.25}, {180, 2}};
    PhaseTableNotes notes;
    const PhaseTable table = make_table(std::span(entries), notes);
    // ∫ of straight lines in the cosine, worked out by hand: 2π Σ (a + b)/2 Δc.
    double sum = 0;
    for (size_t i = 0; i + 1 < entries.size(); ++i)
        sum += 2 * std::numbers::pi * (entries[i].value + entries[i + 1].value) / 2 *
               (std::cos(entries[i].angle * std::numbers::pi / 180) -
                std::cos(entries[i + 1].angle * std::numbers::pi / 180));
    EXPECT_NEAR(notes.integral / sum, 1, 1e-12);
    EXPECT_NEAR(notes.kept, 1, 1e-4);
    for (const PhaseEntry& entry : entries)
        EXPECT_NEAR(table_value(table, std::cos(entry.angle * std::numbers::pi / 180)) * sum / entry.value, 1, 6e-3)
            << entry.angle;
    const double between = 0.5 * (std::cos(30 * std::numbers::pi / 180) + std::cos(90 * std::numbers::pi / 180));
    EXPECT_NEAR(table_value(table, between) * sum, 2, 0.01) << "linear in the cosine";
}

TEST(PhaseTable, OfAKnownFormIsThatForm) {
    for (const double g : {-0.6, 0.0, 0.5, 0.9}) {
        std::vector<PhaseEntry> entries;
        for (int i = 0; i <= 1800; ++i)
            entries.push_back({i / 10.0, 7 * henyey_greenstein(g, std::cos(i * std::numbers::pi / 1800))});
        PhaseTableNotes notes;
        const PhaseTable table = make_table(std::span(entries), notes);
        EXPECT_NEAR(notes.integral, 7, 7e-3);
        EXPECT_NEAR(mean_cosine(table), g, 1e-3);
        for (int i = 0; i <= 180; ++i) {
            const double c = std::cos(i * std::numbers::pi / 180);
            EXPECT_NEAR(table_value(table, c) / henyey_greenstein(g, c), 1, 2e-3) << g << " " << i;
        }
    }
}

TEST(PhaseTable, OfASeriesIsItsSum) {
    for (const double g : {-0.5, 0.2, 0.8}) {
        std::vector<double> coefficients;
        for (int l = 0; l <= 300; ++l) coefficients.push_back(3 * (2 * l + 1) * std::pow(g, l));
        PhaseTableNotes notes;
        const PhaseTable table = make_table(std::span(coefficients), notes);
        EXPECT_EQ(notes.integral, 3);
        EXPECT_LT(notes.negative, 1e-9);
        EXPECT_NEAR(mean_cosine(table), g, 1e-4) << "a third of the second coefficient";
        for (int i = 0; i <= 180; ++i) {
            const double c = std::cos(i * std::numbers::pi / 180);
            EXPECT_NEAR(table_value(table, c) / henyey_greenstein(g, c), 1, 2e-4) << g << " " << i;
        }
    }
}

TEST(PhaseTable, SeriesThatAreCutSayHowFarTheyFallBelowZero) {
    std::vector<double> coefficients;
    for (int l = 0; l <= 8; ++l) coefficients.push_back((2 * l + 1) * std::pow(0.85, l));
    PhaseTableNotes notes;
    const PhaseTable table = make_table(std::span(coefficients), notes);
    EXPECT_GT(notes.negative, 0.01);
    for (const float value : table.values) EXPECT_GE(value, 0);
    EXPECT_NEAR(over_sphere([&](double c) { return table_value(table, c); }), 1, 1e-4);
}

// Narrower than the cosines the table is kept at: it says that the light is lost, and stays finite.
TEST(PhaseTable, SpikesBetweenItsCosinesAreNotKept) {
    const std::vector<PhaseEntry> entries{{0, 0}, {10.00001, 0}, {10.00002, 1}, {10.00003, 0}, {180, 0}};
    PhaseTableNotes notes;
    const PhaseTable table = make_table(std::span(entries), notes);
    EXPECT_GT(std::abs(notes.kept - 1), 0.01);
    for (const float value : table.values) EXPECT_TRUE(std::isfinite(value));
}

TEST(PhaseTable, WidenedIsTheMeanOverDiscs) {
    for (const Phase& narrow : {mie_phase(20), mie_phase(50), tabulated_bow(0.97),
                                mixed_phase(0.5, {PhaseKind::isotropic}, {PhaseKind::henyey_greenstein, -0.98f})}) {
        const double radius = 0.03;
        const Phase wide = widened(narrow, radius);
        EXPECT_NEAR(over_sphere([&](double c) { return phase_value_of<double>(wide, c); }), 1, 1e-4);
        EXPECT_NEAR(mean_cosine(wide), mean_cosine(narrow), 1e-3);
        EXPECT_NEAR(phase_value_of<double>(wide, 0.3) / phase_value_of<double>(narrow, 0.3), 1, 0.01);
        const double inside =
            (1 - cosine_cdf(*narrow.shape, std::cos(radius))) / (2 * std::numbers::pi * (1 - std::cos(radius)));
        EXPECT_NEAR(phase_value_of<double>(wide, 1) / inside, 1, 0.02);
    }
}

TEST(PhaseTable, CosinesThatAreNoneFindAValue) {
    const Phase phase = tabulated_bow(0.8);
    for (const float c : {1.5f, -1.5f, std::nextafter(1.0f, 2.0f), std::nanf("")})
        EXPECT_TRUE(std::isfinite(phase_value(phase, c)) || std::isnan(c)) << c;
    EXPECT_EQ(phase_value(phase, 1.5f), phase_value(phase, 1.0f));
}

TEST(PhaseTable, KnowsHowNarrowItIs) {
    EXPECT_NEAR(narrowest_g(tabulated_bow(0.9)), 0.9, 0.03);
    EXPECT_NEAR(narrowest_g(tabulated_bow(0.97)), 0.97, 0.01);
    EXPECT_LT(narrowest_g(legendre_of(0.0, 1)), 0.01);
}
}
}
