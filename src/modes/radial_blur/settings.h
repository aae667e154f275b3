// Settings of the radial blur.
#pragma once
#include "modes/resolution.h"
#include "modes/settings.h"

namespace tyndall {
struct Rung;

enum class BlurSource { occlusion, highlights };

struct RadialBlurSettings {
    BlurSource source = BlurSource::occlusion;
    int samples = 64;       // along the line to the light
    float density = 0.95f;  // share of that line they cover
    float decay = 0.97f;    // from one of 32 samples to the next
    float weight = 1;       // of every sample
    float exposure = 1;     // of their sum
    float threshold = 1;    // highlights: luminance that counts as bright
    float size = 2.5f;      // occlusion: radius of the bright sky around a sun, in picture heights
    float lamp_size = 0.3f; // occlusion: radius of the bright disc of other lights, metres
    float fade = 2;         // how far outside the picture a light may be before its rays have faded, in half pictures
    Resolution resolution = Resolution::half;
    bool fog = true; // what lies behind fades in homogeneous fog
};

// For its row of the table.
void append_radial_blur_rows(std::vector<SettingRow>& rows);
std::vector<Rung> radial_blur_rungs();
}
