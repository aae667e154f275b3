// Adapts the size of quick images to reach the wanted frame rate.
#pragma once
#include <array>
#include <cstddef>

namespace tyndall {
// Width and height of quick images, as fractions of the full size.
inline constexpr std::array<float, 7> pace_scales{1, 0.75f, 0.5f, 0.375f, 0.25f, 0.1875f, 0.125f};

struct Pace {
    double wanted = 1.0 / 30; // seconds per image
    int level = 4;            // of pace_scales
    int slow_level = -1;      // a level that was too slow,
    int retry_in = 0;         // and the number of images until it is tried again

    float scale() const { return pace_scales[static_cast<size_t>(level)]; }
};

// Updates the level after an image that took `seconds`, `fixed` of them independent of its size. If that was too long,
// drops at once to a level that fits, but allows pixels at least a quarter of the wanted time; rises by one level if
// that is predicted to fit.
void update_pace(Pace& pace, double seconds, double fixed);
}
