// Rows of what every technique shares: how pixels are sampled.
#include "modes/settings_rows.h"

namespace tyndall {
void append_pixel_rows(std::vector<SettingRow>& rows) {
    rows.push_back(number_row("pixel.samples", "", 1, 4096, "camera rays per pixel", TYNDALL_FIELD(pixel.samples)));
    rows.push_back(choice_row("pixel.filter", {"box", "tent", "gaussian", "blackman_harris", "center"},
                              "pixel reconstruction filter; center = every sample at the pixel's centre",
                              TYNDALL_FIELD(pixel.filter)));
    rows.push_back(number_row("pixel.filter_radius", "pixels", 0.25, 4,
                              "how far a sample may lie from the pixel's centre", TYNDALL_FIELD(pixel.filter_radius)));
    rows.push_back(number_row("pixel.lamp_samples", "", 1, 64,
                              "most times as many rays around a local light, whose glow in the fog changes within a "
                              "pixel there; 1 = none more; with --target-error, as measured instead",
                              TYNDALL_FIELD(pixel.lamp_samples)));
    rows.push_back(number_row("pixel.edge_samples", "", 1, 64,
                              "most times as many rays where 4x4 pixels differ: at edges of surfaces and shafts; for "
                              "pictures of 4 rays per pixel or more; 1 = none more; with --target-error, as measured "
                              "instead",
                              TYNDALL_FIELD(pixel.edge_samples)));
    rows.push_back(
        choice_row("pixel.jitter", {"none", "ordered", "white", "blue", "interleaved", "spatiotemporal"},
                   "where in its steps a ray looks: the middle, or shifted by a pattern from pixel to pixel and sample "
                   "to sample (slices and closed forms need none)",
                   TYNDALL_FIELD(pixel.jitter)));
}
}
