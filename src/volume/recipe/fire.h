// A procedural flame: a static heat field that upward-advected noise breaks into tongues.
#pragma once
#include "volume/noise/noise.h"

namespace tyndall {
// With h = height above the base in flame heights, and r = distance from the axis in radii, the heat at a point is
// 1 - h² - r² (1 + taper h)²  +  4 flicker · onset(h) · noise     (below the base 16 depth² in radii instead of h²)
// There is flame where heat > 0; its temperature rises from `edge` at heat 0 to `core` at heat 1 and above.
struct FireRecipe {
    vec3 base{0};                   // meters; center of the burning disc
    float height = 1;               // meters above the base at which a flame without flicker ends
    float radius = 0.25f;           // meters at the base
    float taper = 1;                // 0 dome, 1 roughly a cone, 3 spire
    float core = 1900, edge = 1100; // kelvin
    float air = 300;                // kelvin; smoke outside the flame
    float flicker = 0.5f;           // 0 = static
    float rise = 2;                 // upward speed of the noise, meters per second
    float stretch = 2;              // vertical elongation of the noise features
    FractalNoise noise{.scale = 0.2f};
    float soot = 0.1f; // density at heat 1
    // The rest of the recipe is smoke, inside a plume that ramps up over half a flame height from `smoke_start` flame
    // heights on and whose radius grows by `smoke_spread` per meter.
    float smoke_start = 0.7f, smoke_spread = 0.2f;
};

inline constexpr float fire_noise_gain = 4;     // a noise value of ¼, rarely exceeded, counts as 1
inline constexpr float flicker_at_base = 0.25f; // share of the flicker at the base, rising to all ...
inline constexpr float flicker_full = 0.5f;     // ... at this share of the height. The swirl ramps from 0 likewise.
}
