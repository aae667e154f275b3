#include "base/text.h"
#include "viewer/painting/shown_picture.h"

namespace tyndall {
std::string pixel_text(const PixelValues& values, ivec2 whole, ivec2 pixel) {
    constexpr float middle_gray = 0.18f;
    const ivec2 place = glm::clamp(pixel * values.color.size / whole, ivec2(0), values.color.size - 1);
    const vec3 color = values.color.at(place.x, place.y);
    const float depth = values.depth.at(place.x, place.y), light = luminance(color) / middle_gray;
    std::string text = formatted("%d, %d   R %.4g  G %.4g  B %.4g", pixel.x, pixel.y, color.x, color.y, color.z);
    if (light > 0) text += formatted("   %+.1f stops", std::log2(light));
    return text + (std::isfinite(depth) ? formatted("   %.4g m", depth) : "   no surface");
}
}
