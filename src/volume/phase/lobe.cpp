#include "volume/phase/lobe.h"

#include <cassert>
#include <numbers>

namespace tyndall {
namespace {
constexpr double min_direction = 5e-3; // |g|; lobes below are treated as nearly isotropic

// Unnormalized CDF, ∫ (1 + α m²) (1 + g² - 2 g m)^{-3/2} dm for g > 0, up to a constant. Substituting s² = 1 + g² - 2 g
// m gives ∫ (1 + α m²) / (g s²) ds, with m² a polynomial in s².
double light_up_to(double s, double g, double alpha) {
    const double a = 1 + g * g;
    return (1 / s + alpha / (4 * g * g) * (a * a / s + 2 * a * s - s * s * s / 3)) / g;
}

// CDF of a nearly isotropic lobe, with HG as its first four Legendre terms: error below 6e-9 up to g = 0.005.
double even_share(double g, double alpha, double cosine) {
    const double g2 = g * g, g3 = g2 * g; // HG ≈ a0 + a1 c + a2 c² + a3 c³
    const double a0 = 1 - 2.5 * g2, a1 = 3 * g - 10.5 * g3, a2 = 7.5 * g2, a3 = 17.5 * g3;
    const auto integral = [&](double c) {
        const double c2 = c * c, c3 = c2 * c, c4 = c2 * c2;
        return a0 * c + a1 * c2 / 2 + (a2 + alpha * a0) * c3 / 3 + (a3 + alpha * a1) * c4 / 4 +
               alpha * a2 * c4 * c / 5 + alpha * a3 * c3 * c3 / 6;
    };
    return (integral(cosine) - integral(-1)) / (integral(1) - integral(-1));
}
}

PhaseLobe make_lobe(double weight, double g, double alpha) {
    assert(std::abs(g) < 1 && alpha >= 0);
    PhaseLobe lobe{weight, g, alpha};
    const double size = std::abs(g), whole = 4 * std::numbers::pi * (1 + alpha * (1 + 2 * g * g) / 3);
    const double scale = weight * (1 - g * g) / whole;
    lobe.scale = static_cast<float>(scale), lobe.scale_of_square = static_cast<float>(scale * alpha);
    lobe.gap = static_cast<float>((1 - size) * (1 - size)), lobe.slope = static_cast<float>(2 * size);
    return lobe;
}

double mean_cosine(const PhaseLobe& lobe) {
    const double g = lobe.g, alpha = lobe.alpha;
    return g * (1 + alpha * (3 + 2 * g * g) / 5) / (1 + alpha * (1 + 2 * g * g) / 3);
}

double cosine_cdf(const PhaseLobe& lobe, double cosine) {
    const double g = std::abs(lobe.g), c = lobe.g < 0 ? -cosine : cosine;
    double share = 0;
    if (g > min_direction) {
        const double s = std::sqrt((1 - g) * (1 - g) + 2 * g * (1 - c)), first = light_up_to(1 + g, g, lobe.alpha);
        share = (light_up_to(s, g, lobe.alpha) - first) / (light_up_to(1 - g, g, lobe.alpha) - first);
    } else {
        share = even_share(g, lobe.alpha, c);
    }
    return lobe.g < 0 ? 1 - share : share;
}

// Newton's method with bracketing. The CDF is nearly linear in 1/s (exactly linear for Henyey-Greenstein); for a nearly
// isotropic lobe it is nearly linear in c.
double sampled_cosine(const PhaseLobe& lobe, double u) {
    const double g = std::abs(lobe.g), alpha = lobe.alpha, share = lobe.g < 0 ? 1 - u : u;
    const bool directed = g > min_direction;
    const double first = directed ? light_up_to(1 + g, g, alpha) : 0,
                 all = directed ? light_up_to(1 - g, g, alpha) - first : 2 + alpha * 2 / 3;
    const auto cosine_at = [&](double x) { return directed ? (1 + g * g - 1 / (x * x)) / (2 * g) : x; };
    const auto share_at = [&](double x) {
        return directed ? (light_up_to(1 / x, g, alpha) - first) / all : even_share(g, alpha, x);
    };
    double low = directed ? 1 / (1 + g) : -1, high = directed ? 1 / (1 - g) : 1;
    double x = low + share * (high - low);
    for (int i = 0; i < 60; ++i) {
        const double off = share_at(x) - share, c = cosine_at(x);
        (off > 0 ? high : low) = x;
        double next = x - off * all * (directed ? g : 1.0) / (1 + alpha * c * c);
        if (!(next > low && next < high)) next = 0.5 * (low + high);
        const double step = std::abs(next - x);
        x = next;
        if (step < 1e-12 * high) break;
    }
    const double cosine = std::clamp(cosine_at(x), -1.0, 1.0);
    return lobe.g < 0 ? -cosine : cosine;
}
}
