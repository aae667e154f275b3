// From linear light to what a display shows.
#pragma once
#include <algorithm>
#include <cmath>

namespace tyndall {
// The ACES-like curve of Narkowicz 2015 with the input scaled by 0.6, as in HDR-FLIP (Andersson et al. 2021):
// (a x² + b x) / (c x² + d x + e), within 0..1.
namespace aces_curve {
inline constexpr double a = 0.6 * 0.6 * 2.51, b = 0.6 * 0.03, c = 0.6 * 0.6 * 2.43, d = 0.6 * 0.59, e = 0.14;
}

inline double aces(double x) {
    if (!(x > 0)) return 0;
    if (x > 1e6) return 1; // white; squares of huge values would overflow
    using namespace aces_curve;
    return std::clamp((a * x + b) * x / ((c * x + d) * x + e), 0.0, 1.0);
}

// The light that the curve maps to y, 0 < y < 1: the positive root of (a − c y) x² + (b − d y) x − e y = 0.
inline double aces_inverse(double y) {
    using namespace aces_curve;
    const double p = a - c * y, q = b - d * y;
    return (-q + std::sqrt(q * q + 4 * p * e * y)) / (2 * p);
}
}
