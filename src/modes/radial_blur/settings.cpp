// Settings of radial-blur, with their published names: rows, and the ladder from fastest to most accurate.
#include "modes/radial_blur/settings.h"
#include "modes/mode.h"
#include "modes/settings_rows.h"

namespace tyndall {
void append_radial_blur_rows(std::vector<SettingRow>& rows) {
    rows.push_back(choice_row("radial_blur.source", {"occlusion", "highlights"},
                              "what is blurred: occlusion = the sky around the light, with everything in front of it "
                              "black; highlights = bright parts of the finished image",
                              TYNDALL_FIELD(of<RadialBlurSettings>().source)));
    rows.push_back(number_row("radial_blur.samples", "", 1, 1024, "samples along the line to the light",
                              TYNDALL_FIELD(of<RadialBlurSettings>().samples)));
    rows.push_back(number_row("radial_blur.density", "", 0.01, 1,
                              "fraction of the line to the light that the samples cover",
                              TYNDALL_FIELD(of<RadialBlurSettings>().density)));
    rows.push_back(number_row("radial_blur.decay", "", 0, 1, "brightness factor from one of 32 samples to the next",
                              TYNDALL_FIELD(of<RadialBlurSettings>().decay)));
    rows.push_back(number_row("radial_blur.weight", "", 0, 100, "weight of every sample",
                              TYNDALL_FIELD(of<RadialBlurSettings>().weight)));
    rows.push_back(number_row("radial_blur.exposure", "", 0, 100, "factor on the sum of the samples",
                              TYNDALL_FIELD(of<RadialBlurSettings>().exposure)));
    rows.push_back(number_row("radial_blur.threshold", "", 0, 1e6, "luminance above which highlights are blurred",
                              TYNDALL_FIELD(of<RadialBlurSettings>().threshold)));
    rows.push_back(number_row("radial_blur.size", "image heights", 0.01, 100,
                              "radius at which the bright sky around a sun has faded out",
                              TYNDALL_FIELD(of<RadialBlurSettings>().size)));
    rows.push_back(number_row("radial_blur.lamp_size", "m", 1e-6, 1e9, "radius of the bright disk of other lights",
                              TYNDALL_FIELD(of<RadialBlurSettings>().lamp_size)));
    rows.push_back(number_row("radial_blur.fade", "half images", 0.01, 100,
                              "distance outside the image at which a light's rays have faded out",
                              TYNDALL_FIELD(of<RadialBlurSettings>().fade)));
    rows.push_back(choice_row("radial_blur.resolution", resolutions, "resolution of the blur along each side",
                              TYNDALL_FIELD(of<RadialBlurSettings>().resolution)));
    rows.push_back(choice_row("radial_blur.fog", switches, "homogeneous fog dims surfaces and background",
                              TYNDALL_FIELD(of<RadialBlurSettings>().fog)));
    mark_advanced(rows, {"decay", "weight", "exposure", "fade"});
}

std::vector<Rung> radial_blur_rungs() {
    return {{"", "pixel.samples=1 radial_blur.samples=8 radial_blur.resolution=quarter"},
            {"", "pixel.samples=1 radial_blur.samples=16 radial_blur.resolution=quarter"},
            {"", "pixel.samples=1 radial_blur.samples=32 radial_blur.resolution=half"},
            {"", "pixel.samples=4 radial_blur.samples=64 radial_blur.resolution=half"},
            {"", "pixel.samples=16 radial_blur.samples=128 radial_blur.resolution=full"},
            {"", "pixel.samples=64 radial_blur.samples=256 radial_blur.resolution=full"}};
}
}
