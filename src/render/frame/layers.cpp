#include "render/frame/layers.h"

#include "scene/scene.h"
#include "trace/view.h"

#include <algorithm>

namespace tyndall {
namespace {
// Blends a share of another image into `image`, per pixel.
template<class T, class Share> void blend(Image<T>& image, const Image<T>& other, const Share& share) {
    if (image.empty()) return;
    for (int y = 0; y < image.size.y; ++y)
        for (int x = 0; x < image.size.x; ++x) image.at(x, y) += share({x, y}) * (other.at(x, y) - image.at(x, y));
}

// Blends variances (power 2) or squared standard errors of variances (power 4) of independent images.
template<class T, class Share> void blend_power(Image<T>& image, const Image<T>& other, const Share& share, int power) {
    for (int y = 0; y < image.size.y; ++y)
        for (int x = 0; x < image.size.x; ++x) {
            const float added = share({x, y}), kept = 1 - added;
            const float a = kept * kept, b = added * added;
            image.at(x, y) =
                power == 2 ? a * image.at(x, y) + b * other.at(x, y) : a * a * image.at(x, y) + b * b * other.at(x, y);
        }
}

// Blends images whose two batches continue: the batches' difference is blended, and the variance follows from it.
template<class Share>
void blend_batches(Image<vec3>& apart, const Image<vec3>& other, Image<vec3>& variance, Image<float>& error,
                   const Share& share) {
    blend(apart, other, share);
    for (size_t i = 0; i < apart.pixels.size(); ++i) {
        variance.pixels[i] = apart.pixels[i] * apart.pixels[i] / 4.0f;
        const float mean = mean_component(variance.pixels[i]);
        error.pixels[i] = mean * mean;
    }
}

template<class Share> void blend_batches(Layers& layers, const Layers& other, const Share& share) {
    blend_batches(layers.apart, other.apart, layers.variance, layers.variance_error, share);
    blend_batches(layers.inscatter_apart, other.inscatter_apart, layers.inscatter_variance,
                  layers.inscatter_variance_error, share);
}

template<class Share> void blend_all(Layers& layers, const Layers& other, const Share& share) {
    blend(layers.color, other.color, share);
    blend(layers.alpha, other.alpha, share);
    blend(layers.inscatter, other.inscatter, share);
    blend(layers.transmittance, other.transmittance, share);
    blend(layers.channel_transmittance, other.channel_transmittance, share);
    blend(layers.validity, other.validity, share);
    blend(layers.work, other.work, share);
    blend(layers.half_a, other.half_a, share);
    blend(layers.half_b, other.half_b, share);
    for (size_t i = 0; i < layers.lights.size(); ++i) blend(layers.lights[i].second, other.lights[i].second, share);
    for (const auto part :
         {&Layers::surface, &Layers::background, &Layers::ambient, &Layers::emission, &Layers::multiple})
        blend(layers.*part, other.*part, share);
    add_up(layers);
    if (!other.apart.empty()) return blend_batches(layers, other, share);
    blend_power(layers.variance, other.variance, share, 2);
    blend_power(layers.inscatter_variance, other.inscatter_variance, share, 2);
    blend_power(layers.variance_error, other.variance_error, share, 4);
    blend_power(layers.inscatter_variance_error, other.inscatter_variance_error, share, 4);
}
}

bool has_colored_fog(const Scene& scene) {
    return std::ranges::any_of(scene.media, [](const MediumSource& m) { return m.channel_extinction.has_value(); });
}

void add_up(Layers& layers) {
    for (size_t i = 0; i < layers.channel_transmittance.pixels.size(); ++i) {
        vec3& channels = layers.channel_transmittance.pixels[i];
        const float mean = mean_component(channels), all = layers.transmittance.pixels[i];
        channels = mean > 0 ? channels * (all / mean) : vec3(all);
    }
    for (size_t i = 0; i < layers.ambient.pixels.size(); ++i) {
        vec3 sum(0);
        for (const auto& [name, light] : layers.lights) sum += light.pixels[i];
        layers.inscatter.pixels[i] =
            sum + layers.ambient.pixels[i] + layers.emission.pixels[i] + layers.multiple.pixels[i];
    }
    for (size_t i = 0; i < layers.surface.pixels.size(); ++i)
        layers.color.pixels[i] = layers.surface.pixels[i] + layers.background.pixels[i] + layers.inscatter.pixels[i];
}

void blend_layers(Layers& layers, const Layers& other, float share) {
    blend_all(layers, other, [share](ivec2) { return share; });
}

void blend_layers(Layers& layers, const Layers& other, const TileShares& shares) {
    blend_all(layers, other, [&](ivec2 p) {
        const ivec2 tile = (layers.low + p) / tile_side - shares.low;
        return shares.shares.at(tile.x, tile.y);
    });
}

namespace {
constexpr double certain = 1e9; // degrees of freedom of a variance that is known exactly

double mean_of(const Image<vec3>& image) {
    double sum = 0;
    for (const vec3& value : image.pixels) sum += channel_mean(value);
    return sum / static_cast<double>(image.pixels.size());
}

// 99.5 % quantile of the ratio of two independent χ², each over its degrees of freedom: Fisher's F after Paulson
// (1942). Not valid below three degrees of freedom of the divisor, where the quantile is very large.
double largest_ratio(double above, double below) {
    const double a = 2 / (9 * below), b = 2 / (9 * above), z = noise_deviations * noise_deviations;
    const double square = (1 - a) * (1 - a) - z * a, product = (1 - a) * (1 - b);
    const double root = std::sqrt(std::max(product * product - square * ((1 - b) * (1 - b) - z * b), 0.0));
    return std::pow((product + root) / square, 3);
}

}

double largest_square(double pixels) { return largest_ratio(pixels, certain); }

namespace {
// The squared error of an image is the sum of its pixels', and so is the estimate of its expected value. Each sum
// counts as that of as many squared normals as give it the same variance (Satterthwaite 1946).
Noise noise_of(const Image<vec3>& picture, const Image<vec3>& variances, const Image<float>& squared_errors) {
    const double mean = mean_of(picture), variance = mean_of(variances);
    if (!(variance > 0)) return {};
    if (!(mean > 0)) return {infinity, infinity, infinity};

    double squares = 0, squared_error = 0; // squared_error: of the sum of all variances
    for (const vec3& value : variances.pixels) squares += channel_mean(value) * channel_mean(value);
    for (const double square : squared_errors.pixels) squared_error += square;
    const double sum = variance * static_cast<double>(picture.pixels.size());
    const double pixels = sum * sum / squares, freedom = squared_error > 0 ? 2 * sum * sum / squared_error : certain;
    const auto bound = [&](double known) { return std::sqrt(variance * largest_ratio(pixels, known)) / mean; };
    return {std::sqrt(variance) / mean, bound(std::max(freedom, 3.0)), bound(certain)};
}

Noise worse(const Noise& a, const Noise& b) {
    return {std::max(a.error, b.error), std::max(a.bound, b.bound), std::max(a.settled, b.settled)};
}

// Half the squared differences from adjacent pixels: on average their variance plus half the squared difference of
// their means.
Noise noise_by_neighbors(const Image<vec3>& picture) {
    Image<vec3> variances(picture.size);
    Image<float> errors(picture.size);
    constexpr ivec2 beside[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    for (int y = 0; y < picture.size.y; ++y)
        for (int x = 0; x < picture.size.x; ++x) {
            vec3 sum(0);
            float count = 0;
            for (const ivec2 step : beside) {
                const ivec2 q = ivec2(x, y) + step;
                if (q.x < 0 || q.y < 0 || q.x >= picture.size.x || q.y >= picture.size.y) continue;
                const vec3 apart = picture.at(q.x, q.y) - picture.at(x, y);
                sum += apart * apart / 2.0f, count += 1;
            }
            const vec3 variance = sum / std::max(count, 1.0f);
            const float mean = static_cast<float>(channel_mean(variance));
            variances.at(x, y) = variance, errors.at(x, y) = 2 * mean * mean; // as uncertain as one squared normal
        }
    return noise_of(picture, variances, errors);
}
}

Noise noise_of(const Layers& layers) {
    return worse(noise_of(layers.color, layers.variance, layers.variance_error),
                 noise_of(layers.inscatter, layers.inscatter_variance, layers.inscatter_variance_error));
}

Noise noise_by_neighbors(const Layers& layers) {
    // Along an edge, which crosses a pixel anywhere, the variance is a sixth of the squared step. Half the squared
    // differences are a half of it across the edge and a sixth along it, a third on average: twice the variance.
    const double edge_share = std::sqrt(0.5);
    Noise noise = worse(noise_by_neighbors(layers.color), noise_by_neighbors(layers.inscatter));
    noise.error *= edge_share;
    return noise;
}
}
