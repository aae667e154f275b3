// How large pictures may be so that there are as many in a second as wanted.
#pragma once
#include <array>
#include <cstddef>

namespace tyndall {
// Width and height of quick pictures as shares of the whole one's.
inline constexpr std::array<float, 7> pace_shares{1, 0.75f, 0.5f, 0.375f, 0.25f, 0.1875f, 0.125f};

struct Pace {
    double wanted = 1.0 / 30; // seconds for a picture
    int level = 4;            // of pace_shares
    int barred = -1;          // a level that was too slow,
    int pictures_barred = 0;  // and for how many pictures it is not tried again

    float share() const { return pace_shares[static_cast<size_t>(level)]; }
};

// A picture at the pace's level took so many seconds, `fixed` of them whatever its size. Smaller at once when that was
// too long, but never for less than a quarter of that time spent on pixels; larger by one level when that will fit.
void measured(Pace& pace, double seconds, double fixed);
}
