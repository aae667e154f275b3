// Settings that techniques share: pixel sampling, the terms of the light, multiple scattering, artistic controls.
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
                              "images of 4 rays per pixel or more; 1 = none more; with --target-error, as measured "
                              "instead",
                              TYNDALL_FIELD(pixel.edge_samples)));
    rows.push_back(
        choice_row("pixel.jitter", {"none", "ordered", "white", "blue", "interleaved", "spatiotemporal"},
                   "where in its steps a ray looks: the middle, or shifted by a pattern from pixel to pixel and sample "
                   "to sample (slices and closed forms need none)",
                   TYNDALL_FIELD(pixel.jitter)));
    mark_advanced(rows, {"filter_radius", "jitter"});
}

void append_term_rows(std::vector<SettingRow>& rows) {
    rows.push_back(choice_row("terms.light", {"off", "average", "froxel", "grid", "marched"},
                              "light-side transmittance: how fog dims the light on its way to fog and surfaces; grid = "
                              "looked up in a grid before each light, froxel = in one before the camera (march and "
                              "froxel; others take grid), marched = exact at every point, average = alike everywhere",
                              TYNDALL_FIELD(terms.light)));
    rows.push_back(
        number_row("terms.light_resolution", "cells", 4, 1024,
                   "cells across the fog in the light's grid, none finer than half a voxel, or an eighth from 256 on; "
                   "with froxel, across the image and in depth",
                   TYNDALL_FIELD(terms.light_resolution)));
    rows.push_back(number_row("terms.light_points", "", 1, 256,
                              "points of a soft light that shadows are asked for, by each ray (intervals, exact) or "
                              "step (rays) of march and by each sample of a surface",
                              TYNDALL_FIELD(terms.light_points)));
    rows.push_back(choice_row("terms.phase", switches, "directional scattering; off = the same in all directions",
                              TYNDALL_FIELD(terms.phase)));
    rows.push_back(choice_row("terms.heterogeneity", switches, "density detail; off = every grid at its mean density",
                              TYNDALL_FIELD(terms.heterogeneity)));
    rows.push_back(choice_row("terms.emission", switches, "light that fog gives off; in path, surfaces too",
                              TYNDALL_FIELD(terms.emission)));
    rows.push_back(choice_row("terms.ambient", switches, "ambient light and that of the environment in the fog",
                              TYNDALL_FIELD(terms.ambient)));
}

void set_term_quality(TermSettings& terms, Quality quality) {
    if (quality == Quality::draft) terms.light = LightTransmittance::froxel, terms.light_resolution = 32;
    if (quality == Quality::final) terms.light_resolution = 128;
    if (quality == Quality::reference) terms.light = LightTransmittance::marched, terms.light_resolution = 256;
}

void append_fluence_rows(std::vector<SettingRow>& rows) {
    rows.push_back(
        number_row("fluence.orders", "", 1, all_orders,
                   "most times light scatters in march and froxel, in fog or on surfaces; beyond 1 a grid of "
                   "the light that has scattered before is added to the fog, on top of exact single scattering; "
                   "surfaces keep direct light",
                   TYNDALL_FIELD(fluence.orders)));
    rows.push_back(number_row("fluence.resolution", "cells", 4, 256, "cells of that grid along the fog's longest side",
                              TYNDALL_FIELD(fluence.resolution)));
    rows.push_back(number_row("fluence.paths", "", 64, 1e8, "paths of light that fill it: noise falls with their root",
                              TYNDALL_FIELD(fluence.paths)));
}

void append_style_rows(std::vector<SettingRow>& rows) {
    rows.push_back(number_row("style.light_depth", "", 0, 10,
                              "factor on the optical depth between light and fog; below 1, shafts reach further",
                              TYNDALL_FIELD(style.light_depth)));
    rows.push_back(number_row("style.view_depth", "", 0, 10,
                              "factor on the optical depth between fog and eye, for the fog's own light; above 1, "
                              "shafts are clearer",
                              TYNDALL_FIELD(style.view_depth)));
    rows.push_back(
        number_row("style.density", "", 0, 1000, "factor on every medium's extinction", TYNDALL_FIELD(style.density)));
    rows.push_back(number_row("style.range", "m", 1e-6, 1e9,
                              "distance from the eye at which the fog's light has faded out, over its last fifth",
                              TYNDALL_FIELD(style.range)));
    rows.push_back(color_row("style.tint", "", 0, 100, "factor on the fog's light, R,G,B", TYNDALL_FIELD(style.tint)));
}
}
