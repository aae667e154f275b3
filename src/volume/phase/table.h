// Phase functions given by numbers: at angles, or as a Legendre series. Stored at cosines where a value is found
// without a search, and linear in the cosine between them.
#pragma once
#include "base/math.h"

#include <functional>
#include <span>
#include <vector>

namespace tyndall {
// Values in 1/sr at 2·half + 1 cosines from straight on to straight back: 1 - (i/half)² up to the middle, mirrored
// beyond, so about even in the angle and finest at both ends.
struct PhaseTable {
    int half = 0;
    std::vector<float> values;
    std::vector<double> before; // share of the light at larger cosines, of each

    double cosine(size_t i) const;
    bool empty() const { return values.empty(); }
};

// What was wrong with the numbers, and has been mended.
struct PhaseTableNotes {
    double integral = 1; // over the sphere, as given; the table's is 1
    double negative = 0; // share of the light that was below 0, and is 0 now: of a series that was cut
    double kept = 1;     // of the integral: others lie between the table's cosines
};

struct PhaseEntry {
    double angle, value; // degrees between light and scattered light; any unit
};

// Of at least two entries from 0 to 180 degrees in ascending order, none below 0 and not all 0.
PhaseTable make_table(std::span<const PhaseEntry> entries, PhaseTableNotes& notes);

// Σ coefficient[l] P_l(c) / 4π, the factor 2 l + 1 inside the coefficients (Chandrasekhar's; of SHDOM and its kin).
// The first is above 0.
PhaseTable make_table(std::span<const double> coefficients, PhaseTableNotes& notes);

// value(cosine), in any unit, of a form that has no detail finer than an angle in radians.
PhaseTable make_table(const std::function<double(double)>& value, double finest);

double mean_cosine(const PhaseTable& table);
double sampled_cosine(const PhaseTable& table, double u); // as of a lobe
double share_below(const PhaseTable& table, double cosine);

// |g| of the Henyey-Greenstein lobe as narrow as the narrower of the ends.
double narrowness(const PhaseTable& table);

// Value in 1/sr, to the rounding of T.
template<class T> T table_value(const PhaseTable& table, T cosine) {
    const T half = static_cast<T>(table.half), square = half * half * std::max<T>(0, 1 - std::abs(cosine));
    const int k = std::min(static_cast<int>(std::sqrt(square)), table.half - 1), last = 2 * table.half;
    const T first = static_cast<T>(k), share = (square - first * first) / (2 * first + 1);
    const bool back = cosine < 0;
    const T a = table.values[static_cast<size_t>(back ? last - k : k)],
            b = table.values[static_cast<size_t>(back ? last - k - 1 : k + 1)];
    return a + share * (b - a);
}
}
