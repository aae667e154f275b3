// A flame as a function of place and time: a still body of heat that noise, advected upwards, tears into tongues.
#pragma once
#include "volume/noise/noise.h"

namespace tyndall {
// With h = height above the base in flame heights, and r = distance from the axis in radii, the heat of a place is
//   1 - h² - r² (1 + taper h)²  +  4 flicker · onset(h) · noise     (below the base 16 depth² in radii instead of h²)
// Where it is above 0 there is flame, of `edge` kelvin, and of `core` from heat 1 on.
struct FireRecipe {
    vec3 base{0};                   // metres: the middle of the disc that it burns on
    float height = 1;               // metres above the base at which a still flame ends
    float radius = 0.25f;           // metres at the base
    float taper = 1;                // 0 a dome, 1 about a cone, 3 a spire
    float core = 1900, edge = 1100; // kelvin
    float air = 300;                // kelvin, of smoke outside the flame
    float flicker = 0.5f;           // 0: still
    float rise = 2;                 // metres per second that carry the noise upwards
    float stretch = 2;              // how many times longer than wide what the noise makes is
    FractalNoise noise{.scale = 0.2f};
    float soot = 0.1f; // density at heat 1
    // What else the recipe says makes smoke, within a plume that sets in at `smoke_start` flame heights over another
    // half of one, and whose radius grows by `smoke_spread` per metre.
    float smoke_start = 0.7f, smoke_spread = 0.2f;
};

inline constexpr float fire_noise_gain = 4;     // a noise of ¼, which little of space passes, counts as 1
inline constexpr float flicker_at_base = 0.25f; // share of the flicker there is at the base; all of it from ...
inline constexpr float flicker_full = 0.5f;     // ... this share of the height on. The swirl sets in with it, from 0.
}
