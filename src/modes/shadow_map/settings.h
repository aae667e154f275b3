// Settings of shadow-map.
#pragma once
#include "modes/resolution.h"
#include "modes/settings.h"

namespace tyndall {
struct Rung;

enum class Spacing { angle, distance };

struct ShadowMapSettings {
    int steps = 24; // per ray, and per local light on the segment it reaches
    Spacing spacing = Spacing::angle;
    int resolution = 512; // texels across each map
    int cascades = 3;     // maximum number of maps per sun
    int pcf = 0;          // 0 nearest texel, 1 the four around, 2 sixteen
    float bias = 0;       // texels
    Resolution fog_resolution = Resolution::full;
    bool blur = false; // smooths the jitter pattern
};

// For the mode's row of the table.
void append_shadow_map_rows(std::vector<SettingRow>& rows);
void set_shadow_map_quality(Settings& settings, Quality quality);
std::vector<Rung> shadow_map_rungs();
}
