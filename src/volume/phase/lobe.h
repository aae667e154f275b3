// Lobes of Draine's form (Draine 2003, "Scattering by interstellar dust grains", equation 4), the components of mixed
// phase functions: α = 0 is Henyey-Greenstein, g = 0 with α = 1 is Rayleigh, α = 1 is Cornette-Shanks.
#pragma once
#include "base/math.h"

#include <numbers>

namespace tyndall {
// (1 - g²) (1 + α c²) / (4π (1 + g² - 2 g c)^{3/2} (1 + α (1 + 2 g²) / 3)), times the lobe's weight in the mixture.
struct PhaseLobe {
    double weight = 1, g = 0, alpha = 0;
    // Precomputed for kernels: (scale + scale_of_square·c²) / (gap + slope·(1 - c))^{3/2}, with c negated if g < 0.
    float scale = 0, scale_of_square = 0, gap = 1, slope = 0;
};

// Requires -1 < g < 1 and α >= 0.
PhaseLobe make_lobe(double weight, double g, double alpha);

// ⟨c⟩ = g (1 + α (3 + 2 g²) / 5) / (1 + α (1 + 2 g²) / 3)
double mean_cosine(const PhaseLobe& lobe);

// Inverse CDF: the cosine below which a fraction u of the lobe's light lies.
double sampled_cosine(const PhaseLobe& lobe, double u);

// CDF: the fraction of the lobe's light at smaller cosines.
double cosine_cdf(const PhaseLobe& lobe, double cosine);

// Value in 1/sr, in the precision of T.
template<class T> T lobe_value(const PhaseLobe& lobe, T cosine) {
    const T beside = std::max<T>(1 - (lobe.g < 0 ? -cosine : cosine), 0);
    if constexpr (sizeof(T) == sizeof(float)) {
        const T q = lobe.gap + lobe.slope * beside;
        return (lobe.scale + lobe.scale_of_square * cosine * cosine) / (q * std::sqrt(q));
    } else {
        const T g = std::abs(lobe.g), q = (1 - g) * (1 - g) + 2 * g * beside;
        const T whole = 4 * std::numbers::pi_v<T> * (1 + lobe.alpha * (1 + 2 * g * g) / 3);
        return lobe.weight * (1 - g * g) * (1 + lobe.alpha * cosine * cosine) / (whole * q * std::sqrt(q));
    }
}
}
