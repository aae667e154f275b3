#include "render/image/lettering.h"

// The header defines functions that are not used here.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb_easy_font.h>
#pragma GCC diagnostic pop

#include <array>

namespace tyndall {
namespace {
// Replaces what the font library cannot draw.
std::string plain(const std::string& text) {
    std::string result = text;
    for (char& c : result)
        if (c < 32 || c > 126) c = '?';
    return result;
}

struct Corner {
    float x, y, z;
    std::array<unsigned char, 4> color;
};
}

int text_width(const std::string& text, int scale) { return stb_easy_font_width(plain(text).data()) * scale; }

void draw_text(Image<glm::u8vec3>& picture, ivec2 corner, int scale, const std::string& text, glm::u8vec3 color) {
    std::string letters = plain(text);
    std::vector<Corner> corners(letters.size() * 4 * 20); // a letter is at most 20 bars
    const int bars = stb_easy_font_print(0, 2, letters.data(), nullptr, corners.data(),
                                         static_cast<int>(corners.size() * sizeof(Corner)));
    for (int i = 0; i < bars; ++i) {
        const Corner &first = corners[4 * i], &third = corners[4 * i + 2];
        const ivec2 low = corner + scale * ivec2(vec2(first.x, first.y));
        const ivec2 high = corner + scale * ivec2(vec2(third.x, third.y));
        for (int y = std::max(low.y, 0); y < std::min(high.y, picture.size.y); ++y)
            for (int x = std::max(low.x, 0); x < std::min(high.x, picture.size.x); ++x) picture.at(x, y) = color;
    }
}
}
