// Images of brightness that the radial blur filters.
#pragma once
#include "base/image.h"
#include "modes/radial_blur/radial_blur.h"
#include "modes/radial_blur/settings.h"

namespace tyndall {
// One plane of brightness, or three of color, with a black border two pixels wide, so that bilinear look-ups up to a
// pixel outside need no bounds checks.
struct BlurImage {
    static constexpr int frame = 2;
    ivec2 size{0}; // without the border
    std::vector<Image<float>> planes;

    BlurImage(ivec2 size_, size_t count) : size(size_), planes(count, Image<float>(size_ + 2 * frame)) {}
    float* row(size_t plane, int y) { return &planes[plane].at(frame, y + frame); }
};

// Bright sky around the light where no surface is in front of it; BLEND surfaces transmit 1 - alpha.
BlurImage unoccluded_image(const View& view, const Snapshot& snapshot, const BlurLight& light, ivec2 size);

// The image's light above the threshold in luminance.
BlurImage highlights_image(const Image<vec3>& color, float threshold, ivec2 size);

// Samples along the fraction `density` of the line from a pixel to the light, and their weights.
struct BlurLine {
    float density;
    std::vector<float> weights;
};
BlurLine make_line(const RadialBlurSettings& settings);

// Weighted sums along the lines to `center`, with samples jittered by the view's pattern. `radius`: distance from the
// center beyond which the source is black.
BlurImage blurred(const BlurImage& source, const BlurLine& line, vec2 center, float radius, const View& view);

// Upsamples a glow to the full image, multiplies it by `color` and adds it to `sum` and, unless null, to `part`.
void add_glow(const BlurImage& glow, vec3 color, Image<vec3>& sum, Image<vec3>* part);
}
