// Inverse cumulative distributions of filters, by the midpoint rule.
#include "trace/sampling/pixel_filter.h"

#include <algorithm>
#include <array>
#include <numbers>

namespace tyndall {
namespace {
constexpr int cells = 4096;
// The quantile function of a filter over [-1,1].
struct Quantiles {
    std::array<float, cells + 1> at; // position below which i/cells of it lies
    double area = 0;
};

// Gaussian of standard deviation radius/3, shifted down to 0 at the radius.
double gaussian(double x) { return std::exp(-4.5 * x * x) - std::exp(-4.5); }

// Blackman–Harris window, 4 terms (Harris 1978), over [-1,1]. Multiples of the angle by Chebyshev polynomials.
double blackman_harris(double x) {
    const double one = std::cos(std::numbers::pi * (x + 1)), two = 2 * one * one - 1, three = (2 * two - 1) * one;
    return 0.35875 - 0.48829 * one + 0.14128 * two - 0.01168 * three;
}

// Inverse of the filter's cumulative distribution, by the midpoint rule.
template<class Filter> Quantiles quantiles(Filter filter) {
    constexpr int steps = 1 << 16;
    const auto at = [](int step) { return -1 + 2 * (step + 0.5) / steps; };
    double total = 0, sum = 0;
    for (int i = 0; i < steps; ++i) total += filter(at(i));
    Quantiles result;
    result.at[0] = -1, result.at[cells] = 1, result.area = 2 * total / steps;
    int next = 1;
    for (int i = 0; i < steps && next < cells; ++i) {
        const double share = filter(at(i)) / total;
        for (; next < cells && sum + share >= static_cast<double>(next) / cells; ++next)
            result.at[next] =
                static_cast<float>(-1 + 2 * (i + (static_cast<double>(next) / cells - sum) / share) / steps);
        sum += share;
    }
    return result;
}

float looked_up(const Quantiles& table, float u) {
    const float position = u * cells;
    const int cell = std::min(static_cast<int>(position), cells - 1);
    return table.at[cell] + (position - cell) * (table.at[cell + 1] - table.at[cell]);
}

const Quantiles& gaussian_table() {
    static const Quantiles table = quantiles(gaussian);
    return table;
}

const Quantiles& harris_table() {
    static const Quantiles table = quantiles(blackman_harris);
    return table;
}

// A number in [0,1) turned into an offset in [-1,1], distributed as the filter.
float warped(PixelFilter filter, float u) {
    switch (filter) {
    case PixelFilter::box:
        return 2 * u - 1;
    case PixelFilter::tent:
        return u < 0.5f ? std::sqrt(2 * u) - 1 : 1 - std::sqrt(2 - 2 * u);
    case PixelFilter::gaussian:
        return looked_up(gaussian_table(), u);
    case PixelFilter::blackman_harris:
        return looked_up(harris_table(), u);
    case PixelFilter::center:
        break;
    }
    return 0;
}

double density(PixelFilter filter, float x) {
    if (std::abs(x) > 1) return 0;
    switch (filter) {
    case PixelFilter::box:
        return 0.5;
    case PixelFilter::tent:
        return 1 - std::abs(x);
    case PixelFilter::gaussian:
        return gaussian(x) / gaussian_table().area;
    case PixelFilter::blackman_harris:
        return blackman_harris(x) / harris_table().area;
    case PixelFilter::center:
        break;
    }
    return 0;
}
}

vec2 filter_point(PixelFilter filter, vec2 u) { return {warped(filter, u.x), warped(filter, u.y)}; }

float filter_density(PixelFilter filter, vec2 point) {
    return static_cast<float>(density(filter, point.x) * density(filter, point.y));
}
}
