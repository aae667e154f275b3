// Pictures of brightness that the radial blur smears.
#pragma once
#include "base/image.h"
#include "modes/radial_blur/radial_blur.h"
#include "modes/radial_blur/settings.h"

namespace tyndall {
// One plane of brightness, or three of colour, in a black frame two pixels wide, so that bilinear look-ups up to a
// pixel outside need no care.
struct BlurGlow {
    static constexpr int frame = 2;
    ivec2 size{0}; // within the frame
    std::vector<Image<float>> planes;

    BlurGlow(ivec2 size_, size_t count) : size(size_), planes(count, Image<float>(size_ + 2 * frame)) {}
    float* row(size_t plane, int y) { return &planes[plane].at(frame, y + frame); }
};

// Bright sky around the light where nothing stands before it; BLEND surfaces let their share through.
BlurGlow unoccluded_glow(const View& view, const Snapshot& snapshot, const BlurLight& light, ivec2 size);

// What is brighter than the threshold, less the threshold.
BlurGlow highlights_glow(const Image<vec3>& color, float threshold, ivec2 size);

// Samples along `density` of the line from a pixel to the light, and their weights.
struct BlurLine {
    float density;
    std::vector<float> weights;
};
BlurLine make_line(const RadialBlurSettings& settings);

// Sums along the lines to `center`, their samples jittered as the view asks. `radius`: how far from the centre the
// source is not black.
BlurGlow blurred(const BlurGlow& source, const BlurLine& line, vec2 center, float radius, const View& view);

// Spreads a glow over the full picture, in a colour, and adds it to `sum` and, unless null, to `part`.
void add_glow(const BlurGlow& glow, vec3 color, Image<vec3>& sum, Image<vec3>* part);
}
