// Linear light to displayed color: exposure, view transform, sRGB, dither. PNGs, contact sheets, charts and the viewer
// all use it, so that they look alike.
#pragma once
#include "base/image.h"

#include <string>
#include <vector>

namespace tyndall {
// filmic: AgX, which rolls highlights off over six stops and desaturates them on the way to white.
// srgb: values unchanged, clipped at 1.
enum class ViewTransform { filmic, srgb };
const std::vector<std::string>& view_transform_names();
inline const std::string& name_of(ViewTransform transform) {
    return view_transform_names()[static_cast<size_t>(transform)];
}

struct Display {
    double exposure = 0; // stops
    ViewTransform transform = ViewTransform::filmic;
};

// Linear Rec.709 to sRGB codes, 0..255, accurate to a hundredth of a code. NaN and negative values become black.
vec3 display_value(vec3 linear, const Display& display);

// The same dithered by up to half a code.
glm::u8vec3 display_code(vec3 linear, const Display& display, int x, int y);
Image<glm::u8vec3> display_codes(const Image<vec3>& linear, const Display& display);
}
