// Where in a pixel its samples lie: a scrambled (0,2)-sequence bent into the shape of the pixel filter.
#include "trace/view.h"
#include "base/random.h"

#include <algorithm>
#include <array>

namespace tyndall {
namespace {
constexpr int cells = 4096;
using Quantiles = std::array<float, cells + 1>; // position in [-1,1] below which i/cells of the filter lies

// Gaussian of standard deviation radius/3, lowered to be 0 at the radius.
double gaussian(double x) { return std::exp(-4.5 * x * x) - std::exp(-4.5); }

// Blackman–Harris window, 4 terms (Harris 1978), over [-1,1].
double blackman_harris(double x) {
    const double phase = 3.14159265358979323846 * (x + 1);
    return 0.35875 - 0.48829 * std::cos(phase) + 0.14128 * std::cos(2 * phase) - 0.01168 * std::cos(3 * phase);
}

// Inverse of the filter's cumulative distribution, by summing fine midpoints.
template<class Filter> Quantiles quantiles(Filter filter) {
    constexpr int steps = 1 << 16;
    const auto at = [](int step) { return -1 + 2 * (step + 0.5) / steps; };
    double total = 0, sum = 0;
    for (int i = 0; i < steps; ++i) total += filter(at(i));
    Quantiles result;
    result[0] = -1, result[cells] = 1;
    int next = 1;
    for (int i = 0; i < steps && next < cells; ++i) {
        const double share = filter(at(i)) / total;
        for (; next < cells && sum + share >= static_cast<double>(next) / cells; ++next)
            result[next] = static_cast<float>(-1 + 2 * (i + (static_cast<double>(next) / cells - sum) / share) / steps);
        sum += share;
    }
    return result;
}

float looked_up(const Quantiles& table, float u) {
    const float position = u * cells;
    const int cell = std::min(static_cast<int>(position), cells - 1);
    return table[cell] + (position - cell) * (table[cell + 1] - table[cell]);
}

// A number in [0,1) turned into an offset in [-1,1], distributed as the filter.
float warped(PixelFilter filter, float u) {
    static const Quantiles gaussian_table = quantiles(gaussian), harris_table = quantiles(blackman_harris);
    switch (filter) {
    case PixelFilter::box:
        return 2 * u - 1;
    case PixelFilter::tent:
        return u < 0.5f ? std::sqrt(2 * u) - 1 : 1 - std::sqrt(2 - 2 * u);
    case PixelFilter::gaussian:
        return looked_up(gaussian_table, u);
    case PixelFilter::blackman_harris:
        return looked_up(harris_table, u);
    case PixelFilter::center:
        break;
    }
    return 0;
}
}

namespace {
constexpr int tile_side = 4;

int lamp_factor(const View& view, ivec2 tile) {
    if (view.lamps.empty()) return 1;
    constexpr float reach = 8; // pixels around a lamp in which one sample is too few
    const vec2 low = vec2(tile * tile_side), high = low + static_cast<float>(tile_side);
    float nearest = reach;
    for (const View::Lamp& lamp : view.lamps) {
        const float away = glm::distance(glm::clamp(lamp.at, low, high), lamp.at);
        nearest = std::min(nearest, std::max({away, lamp.radius, 1.0f}));
    }
    return std::clamp(static_cast<int>((reach / nearest) * (reach / nearest)), 1, view.lamp_samples);
}
}

int samples_of(const View& view, ivec2 pixel) {
    const ivec2 tile = pixel / tile_side;
    return view.pixel_samples * std::max(lamp_factor(view, tile), view.edges ? view.edges->at(tile) : 1);
}

SamplePlace sample_place(const View& view, ivec2 pixel, int sample) {
    const int size = samples_of(view, pixel) / view.batches, batch = sample / size;
    const uint32_t key = hash(static_cast<uint32_t>(pixel.x), static_cast<uint32_t>(pixel.y), view.seed,
                              static_cast<uint32_t>(view.frame));
    return {batch ? hash(key, static_cast<uint32_t>(batch)) : key, static_cast<uint32_t>(sample % size)};
}

vec2 sample_position(const View& view, ivec2 pixel, int sample) {
    const vec2 center = vec2(pixel) + 0.5f;
    if (samples_of(view, pixel) == 1 || view.filter == PixelFilter::center) return center;
    const SamplePlace place = sample_place(view, pixel, sample);
    const Sample2 u = sample2(place.index, place.sequence);
    return center + view.filter_radius * vec2(warped(view.filter, u.x), warped(view.filter, u.y));
}
}
