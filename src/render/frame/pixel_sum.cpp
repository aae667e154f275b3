#include "render/frame/pixel_sum.h"

namespace tyndall {
void RunningMean::add(vec3 value) {
    const dvec3 deviation = dvec3(value) - mean;
    mean += deviation / static_cast<double>(++count);
    squares += deviation * (dvec3(value) - mean);
}

vec3 RunningMean::variance() const {
    return count < 2 ? vec3(0) : vec3(squares / (static_cast<double>(count) * (count - 1)));
}

void RunningSpread::add(vec3 value) {
    const double n = count + 1;
    const dvec3 part = (dvec3(value) - mean) / n, square = part * part, term = square * n * (n - 1);
    fourths += term * square * (n * n - 3 * n + 3) + 6.0 * square * squares - 4.0 * part * cubes;
    cubes += term * part * (n - 2) - 3.0 * part * squares;
    RunningMean::add(value);
}

float RunningSpread::variance_error() const {
    const double n = count;
    return count < 2 ? 0 : static_cast<float>((fourths.x + fourths.y + fourths.z) / (3 * n * std::pow(n - 1, 3)));
}

void PixelSum::add(const PixelSample& sample) {
    surface += sample.surface, background += sample.background, inscatter += sample.inscatter;
    const float w = sample.weight;
    ++kept, weight += w, alpha += w * sample.alpha, transmittance += w * sample.transmittance,
        validity += w * sample.validity;
    if (sample.off_center < off_center) off_center = sample.off_center, depth = sample.depth;
}

void PixelSum::end_batch(int samples) {
    const float count = static_cast<float>(samples);
    const vec3 color = surface + background + inscatter;
    half_means[color_mean.count % 2].add(color / count);
    fog_half_means[color_mean.count % 2].add(inscatter / count);
    color_mean.add(color / count);
    surface_mean.add(surface / count), background_mean.add(background / count);
    inscatter_mean.add(inscatter / count);
    surface = background = inscatter = vec3(0);
}

vec3 PixelSum::mean_color() const {
    return vec3(surface_mean.mean) + vec3(background_mean.mean) + vec3(inscatter_mean.mean);
}

void store_pixel(const PixelSum& sum, int samples, ivec2 p, Layers& layers) {
    const float all = static_cast<float>(samples);
    const float count = sum.kept ? sum.weight * all / static_cast<float>(sum.kept) : all;
    layers.color.at(p.x, p.y) = sum.mean_color();
    if (!layers.surface.empty()) {
        layers.surface.at(p.x, p.y) = vec3(sum.surface_mean.mean);
        layers.background.at(p.x, p.y) = vec3(sum.background_mean.mean);
    }
    layers.inscatter.at(p.x, p.y) = vec3(sum.inscatter_mean.mean);
    layers.alpha.at(p.x, p.y) = sum.alpha / count;
    layers.depth.at(p.x, p.y) = sum.depth;
    layers.transmittance.at(p.x, p.y) = sum.transmittance / count;
    layers.validity.at(p.x, p.y) = sum.validity / count;
    if (!layers.variance.empty()) layers.variance.at(p.x, p.y) = sum.color_mean.variance();
    if (!layers.inscatter_variance.empty()) layers.inscatter_variance.at(p.x, p.y) = sum.inscatter_mean.variance();
    if (!layers.variance_error.empty()) layers.variance_error.at(p.x, p.y) = sum.color_mean.variance_error();
    if (!layers.inscatter_variance_error.empty())
        layers.inscatter_variance_error.at(p.x, p.y) = sum.inscatter_mean.variance_error();
    if (!layers.apart.empty()) {
        layers.apart.at(p.x, p.y) = vec3(sum.half_means[0].mean - sum.half_means[1].mean);
        layers.inscatter_apart.at(p.x, p.y) = vec3(sum.fog_half_means[0].mean - sum.fog_half_means[1].mean);
    }
    if (layers.half_a.empty()) return;
    layers.half_a.at(p.x, p.y) = vec3(sum.half_means[0].mean);
    layers.half_b.at(p.x, p.y) = vec3(sum.half_means[1].mean);
}
}
