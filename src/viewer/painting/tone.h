// Converts layers of an image to codes for the screen.
#pragma once
#include "render/image/view_transform.h"

#include <optional>
#include <string>
#include <vector>

namespace tyndall {
struct Layers;

enum class ShownLayer { picture, fog, transmittance, depth, validity, stops, error };
const std::vector<std::string>& shown_layer_names();

struct DisplayOptions {
    ShownLayer layer = ShownLayer::picture;
    std::optional<double> exposure; // stops; of picture and fog; none = measured
    ViewTransform transform = ViewTransform::filmic;
    float wipe = 0.5f;         // fraction of the width at which the comparison mode begins
    bool side_by_side = false; // both in full instead

    Display display() const { return {exposure.value_or(0.0), transform}; }
};

// Range of stops around middle gray that false colors distinguish, one color per stop.
inline constexpr int lowest_stop = -8, highest_stop = 8;
glm::u8vec3 color_of_stop(int stop);

// Picture and fog look like their PNGs. Transmittance is gray, or colored if it differs by channel, and white at 1.
// Depth is brighter the nearer, and black without a surface. Validity is the picture in gray, redder where validity is
// lower. Stops are false colors of the picture's luminance. Error shows the picture: errors need a reference. Alpha is
// 255.
Image<glm::u8vec4> tone_map(const Layers& layers, const DisplayOptions& shown);
}
