#include "measure/chart/errors.h"

#include <cassert>
#include <limits>

namespace tyndall {
namespace {
constexpr double rel_mse_epsilon = 0.01; // of the squared mean

double mean_of(const Image<vec3>& image) {
    double sum = 0;
    for (const vec3 value : image.pixels) sum += double{value.x} + value.y + value.z;
    return sum / (3 * static_cast<double>(image.pixels.size()));
}

double mean_square(const Image<vec3>& picture, const Image<vec3>& a, const Image<vec3>& b) {
    return product_of_errors(picture, picture, a, b).value;
}

// Standard deviation of the mean of (A − R1)·(A − R2) = (A − R)² − d²/4, where R is the mean of the halves and d their
// difference, normal with variance 2v. The variance of R is v/2, estimated by d²/4; that of d²/4 is estimated by d⁴/24.
// The channels of a pixel are taken as fully correlated, pixels as independent.
double noise_of_square(const Image<vec3>& picture, const Image<vec3>& a, const Image<vec3>& b) {
    double variance = 0;
    for (size_t i = 0; i < picture.pixels.size(); ++i) {
        const dvec3 r1 = a.pixels[i], r2 = b.pixels[i], d = r1 - r2, e = dvec3(picture.pixels[i]) - 0.5 * (r1 + r2);
        const double linear = glm::dot(e, d), square = glm::dot(d, d);
        variance += linear * linear + square * square / 24;
    }
    return std::sqrt(variance) / (3 * static_cast<double>(picture.pixels.size()));
}

double root_share(double square, double mean) { return relative(std::sqrt(std::max(square, 0.0)), mean); }

// Uncertainty of a root from the standard deviation of its square; for a square of 0, the root of the deviation.
double uncertainty(double square, double deviation, double mean) {
    const double root = std::sqrt(std::max(square, 0.0));
    return relative(std::sqrt(root * root + deviation) - root, mean);
}

double rel_mse(const ReferenceMetrics& reference_metrics, const Image<vec3>& color) {
    const Image<vec3>&a = reference_metrics.halves[0].color, &b = reference_metrics.halves[1].color;
    const double epsilon = rel_mse_epsilon * reference_metrics.mean * reference_metrics.mean;
    double sum = 0;
    for (size_t i = 0; i < color.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const double own = color.pixels[i][c], r = reference_metrics.shown_mean.color.pixels[i][c];
            sum += (own - a.pixels[i][c]) * (own - b.pixels[i][c]) / (r * r + epsilon);
        }
    return std::max(sum, 0.0) / (3 * static_cast<double>(color.pixels.size()));
}

double bias(const Image<vec3>& picture, const std::array<const Image<vec3>*, 2>& halves, double mean) {
    return relative(mean_of(picture) - 0.5 * (mean_of(*halves[0]) + mean_of(*halves[1])), mean);
}
}

ReferenceMetrics make_metrics(const Reference& reference, bool lights_only) {
    ReferenceMetrics result;
    result.halves = reference.halves;
    result.shown_mean = mean_of(reference.halves);
    if (lights_only) {
        for (size_t half = 0; half < 2; ++half) {
            const ColorLayers& unlit = reference.unlit[half];
            result.halves[half].color = minus(result.halves[half].color, unlit.color);
            result.halves[half].inscatter = minus(result.halves[half].inscatter, unlit.inscatter);
        }
        result.added = mean_of(reference.unlit);
    }
    result.viewing = viewing_of(result.shown_mean.color);
    result.mean = mean_of(result.shown_mean.color), result.inscatter_mean = mean_of(result.shown_mean.inscatter);
    return result;
}

Image<vec3> whole(const ReferenceMetrics& reference_metrics, const Image<vec3>& color) {
    Image<vec3> result = color;
    for (size_t i = 0; i < reference_metrics.added.color.pixels.size(); ++i)
        result.pixels[i] += reference_metrics.added.color.pixels[i];
    return result;
}

ChartErrors chart_errors(const ReferenceMetrics& reference_metrics, const ColorLayers& picture) {
    const ColorLayers &a = reference_metrics.halves[0], &b = reference_metrics.halves[1];
    const double square = mean_square(picture.color, a.color, b.color);
    const double fog_square = mean_square(picture.inscatter, a.inscatter, b.inscatter);
    ChartErrors result;
    result.rmse = root_share(square, reference_metrics.mean);
    result.inscatter_rmse = root_share(fog_square, reference_metrics.inscatter_mean);
    result.error = std::max(result.rmse, result.inscatter_rmse);

    const double own = uncertainty(square, noise_of_square(picture.color, a.color, b.color), reference_metrics.mean);
    const double fog_noise = noise_of_square(picture.inscatter, a.inscatter, b.inscatter);
    result.inscatter_uncertainty = uncertainty(fog_square, fog_noise, reference_metrics.inscatter_mean);
    result.uncertainty = result.inscatter_rmse > result.rmse ? result.inscatter_uncertainty : own;
    result.bias = bias(picture.color, {&a.color, &b.color}, reference_metrics.mean);
    result.inscatter_bias = bias(picture.inscatter, {&a.inscatter, &b.inscatter}, reference_metrics.inscatter_mean);
    result.rel_mse = rel_mse(reference_metrics, picture.color);
    result.flip = flip_mean(flip_hdr(whole(reference_metrics, picture.color), reference_metrics.shown_mean.color,
                                     reference_metrics.viewing.exposures, reference_metrics.viewing.pixels_per_degree));
    return result;
}

double fitted_gain(const ReferenceMetrics& reference_metrics, const ColorLayers& picture) {
    double product = 0, square = 0;
    for (size_t i = 0; i < picture.inscatter.pixels.size(); ++i) {
        const dvec3 own = picture.inscatter.pixels[i];
        const dvec3 a = reference_metrics.halves[0].inscatter.pixels[i],
                    b = reference_metrics.halves[1].inscatter.pixels[i];
        product += 0.5 * glm::dot(own, a + b), square += glm::dot(own, own);
    }
    return square > 0 ? product / square : 1;
}

ColorLayers with_gain(const ColorLayers& picture, double gain) {
    ColorLayers result = picture;
    const float more = static_cast<float>(gain - 1);
    for (size_t i = 0; i < result.color.pixels.size(); ++i) {
        result.color.pixels[i] += more * picture.inscatter.pixels[i];
        result.inscatter.pixels[i] += more * picture.inscatter.pixels[i];
    }
    return result;
}

double chart_flicker(std::span<const ReferenceMetrics> frames, std::span<const ColorLayers> pictures) {
    assert(frames.size() == pictures.size());
    double squares = 0, mean = 0;
    for (size_t t = 0; t < frames.size(); ++t) {
        mean += frames[t].mean / static_cast<double>(frames.size());
        if (t == 0) continue;
        const auto change = [t](const auto& image_at) { return minus(image_at(t), image_at(t - 1)); };
        const Image<vec3> own = change([&](size_t i) -> const Image<vec3>& { return pictures[i].color; });
        const Image<vec3> a = change([&](size_t i) -> const Image<vec3>& { return frames[i].halves[0].color; });
        const Image<vec3> b = change([&](size_t i) -> const Image<vec3>& { return frames[i].halves[1].color; });
        squares += mean_square(own, a, b) / static_cast<double>(frames.size() - 1);
    }
    if (frames.size() < 2) return std::numeric_limits<double>::quiet_NaN();
    return root_share(squares, mean);
}
}
