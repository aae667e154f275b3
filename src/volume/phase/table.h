// Tabulated phase functions, given at angles or as a Legendre series. Stored at cosines that allow lookup without a
// search, with linear interpolation in the cosine.
#pragma once
#include "base/math.h"

#include <functional>
#include <span>
#include <vector>

namespace tyndall {
// Values in 1/sr at 2·half + 1 cosines from forward to backward: 1 - (i/half)² for the first half and mirrored for the
// second, which is roughly uniform in the angle and finest at both ends.
struct PhaseTable {
    int half = 0;
    std::vector<float> values;
    std::vector<double> cdf; // per entry: fraction of the light at larger cosines

    double cosine(size_t i) const;
    bool empty() const { return values.empty(); }
};

// Corrections made to the input.
struct PhaseTableNotes {
    double integral = 1; // over the sphere, of the input; the table's is 1
    double negative = 0; // share of the light that was negative and is clamped to 0, as in truncated series
    double kept = 1;     // ratio of the table's integral to the input's; entries between the table's cosines are lost
};

struct PhaseEntry {
    double angle, value; // scattering angle in degrees; value in any unit
};

// From at least two entries, ascending from 0 to 180 degrees, with nonnegative values that are not all 0.
PhaseTable make_table(std::span<const PhaseEntry> entries, PhaseTableNotes& notes);

// Σ coefficient[l] P_l(c) / 4π, with the factor 2 l + 1 included in the coefficients (Chandrasekhar's convention, used
// by SHDOM). The first must be positive.
PhaseTable make_table(std::span<const double> coefficients, PhaseTableNotes& notes);

// From value(cosine), in any unit, with no detail finer than the angle `finest` in radians.
PhaseTable make_table(const std::function<double(double)>& value, double finest);

double mean_cosine(const PhaseTable& table);
double sampled_cosine(const PhaseTable& table, double u); // as for a lobe
double cosine_cdf(const PhaseTable& table, double cosine);

// |g| of the Henyey-Greenstein lobe as narrow as the narrower of the forward and backward peaks.
double narrowness(const PhaseTable& table);

// Value in 1/sr, in the precision of T.
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
