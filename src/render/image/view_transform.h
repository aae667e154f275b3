// How light becomes a picture for eyes: exposure, view transform, sRGB, dither. PNGs, contact sheets, charts and the
// viewer come through here, so that they look alike.
#pragma once
#include "base/image.h"

#include <string>
#include <vector>

namespace tyndall {
// filmic: AgX, which rolls highlights off over six stops and lets them lose their colour on the way to white.
// srgb: values as they are, cut off at 1.
enum class ViewTransform { filmic, srgb };
const std::vector<std::string>& view_transform_names();
inline const std::string& name_of(ViewTransform transform) {
    return view_transform_names()[static_cast<size_t>(transform)];
}

struct Display {
    double exposure = 0; // stops
    ViewTransform transform = ViewTransform::filmic;
};

// Linear Rec.709 as a display shows it: sRGB codes, 0..255, within a hundredth of a code. What is no colour is black.
vec3 display_value(vec3 linear, const Display& display);

// The same dithered by up to half a code.
glm::u8vec3 display_code(vec3 linear, const Display& display, int x, int y);
Image<glm::u8vec3> display_codes(const Image<vec3>& linear, const Display& display);
}
