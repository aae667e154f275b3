// Text on 8-bit images.
#pragma once
#include "base/image.h"

#include <string>

namespace tyndall {
inline constexpr int letter_height = 12; // of a line at scale 1, pixels

// Printable ASCII; other bytes show as '?'. Text is clipped to the image.
int text_width(const std::string& text, int scale);
void draw_text(Image<glm::u8vec3>& picture, ivec2 corner, int scale, const std::string& text, glm::u8vec3 color);
}
