// Layers of a picture as codes for the screen.
#pragma once
#include "render/image/view_transform.h"

#include <optional>
#include <string>
#include <vector>

namespace tyndall {
struct Layers;

enum class ShownLayer { picture, fog, transmittance, depth, validity, stops, error };
const std::vector<std::string>& shown_layer_names();

struct Shown {
    ShownLayer layer = ShownLayer::picture;
    std::optional<double> exposure; // stops; of picture and fog; none = measured
    ViewTransform transform = ViewTransform::filmic;
    float wipe = 0.5f;         // share of the width where a mode beside begins
    bool side_by_side = false; // both whole instead

    Display display() const { return {exposure.value_or(0.0), transform}; }
};

// Stops from middle grey that false colours tell apart, one colour each.
inline constexpr int lowest_stop = -8, highest_stop = 8;
glm::u8vec3 color_of_stop(int stop);

// Picture and fog look as their PNGs do. Transmittance is grey, white at 1. Depth is bright where it is near, black
// without a surface. Where validity is lower, the picture's grey turns red. Stops are false colours of the picture's
// luminance. Errors need a reference: without one, the picture. Alpha is 255.
Image<glm::u8vec4> toned(const Layers& layers, const Shown& shown);
}
