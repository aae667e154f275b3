// Settings that techniques share: pixel sampling, the terms of the light, multiple scattering, artistic controls.
#include "modes/settings_rows.h"

namespace tyndall {
void append_pixel_rows(std::vector<SettingRow>& rows) {
    rows.push_back(number_row("pixel.samples", "", 1, 4096,
                              "camera rays per pixel; path takes 16 times the number of a quality",
                              TYNDALL_FIELD(pixel.samples)));
    rows.push_back(choice_row("pixel.filter", {"box", "tent", "gaussian", "blackman_harris", "center"},
                              "pixel reconstruction filter; center = every sample at the pixel center",
                              TYNDALL_FIELD(pixel.filter)));
    rows.push_back(number_row("pixel.filter_radius", "pixels", 0.25, 4,
                              "maximum distance of a sample from the pixel center",
                              TYNDALL_FIELD(pixel.filter_radius)));
    rows.push_back(number_row(
        "pixel.lamp_samples", "", 1, 64,
        "maximum factor on samples around a local light, whose glow in the fog changes within a pixel there; 1 = no "
        "extra samples; ignored with --target-error, which distributes samples by measured error",
        TYNDALL_FIELD(pixel.lamp_samples)));
    rows.push_back(number_row(
        "pixel.edge_samples", "", 1, 64,
        "maximum factor on samples where 4x4 pixels differ, at edges of surfaces and shafts; used from 4 samples per "
        "pixel on; 1 = no extra samples; ignored with --target-error, which distributes samples by measured error",
        TYNDALL_FIELD(pixel.edge_samples)));
    rows.push_back(choice_row("pixel.jitter", {"none", "ordered", "white", "blue", "interleaved", "spatiotemporal"},
                              "where in each step a ray samples: at the middle, or shifted by a pattern from pixel to "
                              "pixel and sample to sample (closed forms need none)",
                              TYNDALL_FIELD(pixel.jitter)));
    mark_advanced(rows, {"filter_radius", "jitter"});
}

void append_term_rows(std::vector<SettingRow>& rows) {
    rows.push_back(
        choice_row("terms.light", {"off", "average", "froxel", "grid", "marched"},
                   "light-side transmittance: how fog dims the light on its way to fog and surfaces; grid = looked up "
                   "in a grid per light, froxel = in froxels of the camera's view (march and froxel; other modes use "
                   "grid), marched = exact at every point, average = the same everywhere",
                   TYNDALL_FIELD(terms.light)));
    rows.push_back(number_row("terms.light_resolution", "cells", 4, 1024,
                              "cells across the fog in each light's grid, no finer than half a voxel (an eighth of a "
                              "voxel from 256 on); with froxel, across the image and in depth",
                              TYNDALL_FIELD(terms.light_resolution)));
    rows.push_back(number_row("terms.light_points", "", 1, 256,
                              "sample points on a soft light for shadows, per ray (intervals, exact) or step (rays) of "
                              "march and per sample of a surface",
                              TYNDALL_FIELD(terms.light_points)));
    rows.push_back(
        choice_row("terms.phase", switches, "directional scattering; off = isotropic", TYNDALL_FIELD(terms.phase)));
    rows.push_back(choice_row("terms.heterogeneity", switches, "density detail; off = every grid at its mean density",
                              TYNDALL_FIELD(terms.heterogeneity)));
    rows.push_back(choice_row("terms.emission", switches, "light emitted by fog; in path, also by surfaces",
                              TYNDALL_FIELD(terms.emission)));
    rows.push_back(choice_row("terms.ambient", switches, "ambient and environment light in the fog",
                              TYNDALL_FIELD(terms.ambient)));
}

void set_term_quality(TermSettings& terms, Quality quality) {
    if (quality == Quality::draft) terms.light = LightTransmittance::froxel, terms.light_resolution = 32;
    if (quality == Quality::final) terms.light_resolution = 128;
    if (quality == Quality::reference) terms.light = LightTransmittance::marched, terms.light_resolution = 256;
}

void append_fluence_rows(std::vector<SettingRow>& rows) {
    rows.push_back(number_row(
        "fluence.orders", "", 1, all_orders,
        "maximum scattering order in march and froxel, in fog or on surfaces; above 1, multiple scattering from a grid "
        "is added to the fog, on top of exact single scattering; surfaces receive only direct light",
        TYNDALL_FIELD(fluence.orders)));
    rows.push_back(number_row("fluence.resolution", "cells", 4, 256,
                              "cells of the multiple-scattering grid along the fog's longest side",
                              TYNDALL_FIELD(fluence.resolution)));
    rows.push_back(number_row(
        "fluence.paths", "", 64, 1e8,
        "light paths traced to fill the multiple-scattering grid; noise falls with the square root of their number",
        TYNDALL_FIELD(fluence.paths)));
}

void append_style_rows(std::vector<SettingRow>& rows) {
    rows.push_back(number_row("style.light_depth", "", 0, 10,
                              "factor on the optical depth between light and fog; below 1, shafts reach further",
                              TYNDALL_FIELD(style.light_depth)));
    rows.push_back(number_row(
        "style.view_depth", "", 0, 10,
        "factor on the optical depth between fog and camera, for the fog's own light; above 1, shafts are clearer",
        TYNDALL_FIELD(style.view_depth)));
    rows.push_back(number_row("style.density", "", 0, 1000,
                              "factor on every medium's extinction, and on emission that follows its density",
                              TYNDALL_FIELD(style.density)));
    rows.push_back(
        number_row("style.range", "m", 1e-6, 1e9,
                   "distance from the camera at which the fog's light has faded out, over the last fifth of it",
                   TYNDALL_FIELD(style.range)));
    rows.push_back(color_row("style.tint", "", 0, 100, "factor on the fog's light, R,G,B", TYNDALL_FIELD(style.tint)));
}
}
