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
    float density = 0.95f;  // fraction of that line they cover
    float decay = 0.97f;    // factor from one of 32 samples to the next
    float weight = 1;       // factor on each sample
    float exposure = 1;     // factor on their sum
    float threshold = 1;    // highlights: luminance above which pixels count as bright
    float size = 2.5f;      // occlusion: radius of the bright sky around a sun, in image heights
    float lamp_size = 0.3f; // occlusion: radius of the bright disk of other lights, meters
    float fade = 2;         // distance outside the image at which a light's rays have faded out, in half image sizes
    Resolution resolution = Resolution::half;
    bool fog = true; // homogeneous fog attenuates surfaces and background
};

// For the mode's row of the table.
void append_radial_blur_rows(std::vector<SettingRow>& rows);
std::vector<Rung> radial_blur_rungs();
}
