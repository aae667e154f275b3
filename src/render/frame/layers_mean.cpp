#include "render/frame/layers_mean.h"

namespace tyndall {
namespace {
// Into `image` a share of another one.
template<class T> void blend(Image<T>& image, const Image<T>& other, float share) {
    for (size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] += share * (other.pixels[i] - image.pixels[i]);
}

// Variance of the blended mean of independent pictures.
void blend_variance(Image<vec3>& variance, const Image<vec3>& other, float share) {
    const float kept = (1 - share) * (1 - share), added = share * share;
    for (size_t i = 0; i < variance.pixels.size(); ++i)
        variance.pixels[i] = kept * variance.pixels[i] + added * other.pixels[i];
}
}

void blend_layers(Layers& layers, const Layers& other, float share) {
    blend(layers.color, other.color, share);
    blend(layers.alpha, other.alpha, share);
    blend(layers.inscatter, other.inscatter, share);
    blend(layers.transmittance, other.transmittance, share);
    blend(layers.validity, other.validity, share);
    blend(layers.half_a, other.half_a, share);
    blend(layers.half_b, other.half_b, share);
    for (size_t i = 0; i < layers.lights.size(); ++i) blend(layers.lights[i].second, other.lights[i].second, share);
    blend_variance(layers.variance, other.variance, share);
    blend_variance(layers.inscatter_variance, other.inscatter_variance, share);
}
}
