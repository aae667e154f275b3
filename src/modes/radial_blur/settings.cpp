// Rows of the radial blur, by their published names.
#include "modes/settings_rows.h"

namespace tyndall {
void append_radial_blur_rows(std::vector<SettingRow>& rows) {
    rows.push_back(choice_row("radial_blur.source", {"occlusion", "highlights"},
                              "what is blurred: the sky around the light with everything in front of it black, or what "
                              "is bright in the finished picture",
                              TYNDALL_FIELD(radial_blur.source)));
    rows.push_back(number_row("radial_blur.samples", "", 1, 1024, "samples along the line to the light",
                              TYNDALL_FIELD(radial_blur.samples)));
    rows.push_back(number_row("radial_blur.density", "", 0.01, 1, "share of the line to the light that they cover",
                              TYNDALL_FIELD(radial_blur.density)));
    rows.push_back(number_row("radial_blur.decay", "", 0, 1, "what is left from one of 32 samples to the next",
                              TYNDALL_FIELD(radial_blur.decay)));
    rows.push_back(
        number_row("radial_blur.weight", "", 0, 100, "weight of every sample", TYNDALL_FIELD(radial_blur.weight)));
    rows.push_back(
        number_row("radial_blur.exposure", "", 0, 100, "factor on their sum", TYNDALL_FIELD(radial_blur.exposure)));
    rows.push_back(number_row("radial_blur.threshold", "", 0, 1e6, "luminance above which highlights are blurred",
                              TYNDALL_FIELD(radial_blur.threshold)));
    rows.push_back(number_row("radial_blur.size", "picture heights", 0.01, 100,
                              "radius at which the bright sky around a sun has faded",
                              TYNDALL_FIELD(radial_blur.size)));
    rows.push_back(number_row("radial_blur.lamp_size", "m", 0.001, 1000, "radius of the bright disc of other lights",
                              TYNDALL_FIELD(radial_blur.lamp_size)));
    rows.push_back(number_row("radial_blur.fade", "half pictures", 0.01, 100,
                              "how far outside the picture a light is when its rays have faded",
                              TYNDALL_FIELD(radial_blur.fade)));
    rows.push_back(choice_row("radial_blur.picture", picture_shares, "resolution of the blur along each side",
                              TYNDALL_FIELD(radial_blur.picture)));
    rows.push_back(choice_row("radial_blur.fog", switches, "surfaces and background fade in fog, taken as even",
                              TYNDALL_FIELD(radial_blur.fog)));
}
}
