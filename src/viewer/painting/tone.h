// Layers of a picture as codes for the screen.
#pragma once
#include "base/image.h"

#include <string>
#include <vector>

namespace tyndall {
struct Layers;

enum class ShownLayer { picture, fog, transmittance, depth, validity, error };
const std::vector<std::string>& shown_layer_names();

struct Shown {
    ShownLayer layer = ShownLayer::picture;
    float exposure = 0;        // stops; of picture and fog
    float wipe = 0.5f;         // share of the width where a mode beside begins
    bool side_by_side = false; // both whole instead
};

// ShownPicture and fog look as their PNGs do: the same curve and dither, rounded by less than a hundredth of a code.
// Transmittance is grey, nearly white at 1. Depth is bright where it is near, black without a surface. Where validity
// is lower, the picture's grey turns red. Errors need a reference: without one, the picture. Alpha is 255.
Image<glm::u8vec4> toned(const Layers& layers, const Shown& shown);
}
