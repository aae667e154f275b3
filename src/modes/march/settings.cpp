// Rows of the main renderer.
#include "modes/settings_rows.h"

namespace tyndall {
void append_march_rows(std::vector<SettingRow>& rows) {
    rows.push_back(number_row("march.step_depth", "", 1e-4, 10, "most optical depth one step may cross",
                              TYNDALL_FIELD(march.step_depth)));
    rows.push_back(number_row("march.step_voxels", "voxels", 0.05, 64, "most voxels one step may cross",
                              TYNDALL_FIELD(march.step_voxels)));
    rows.push_back(number_row("march.step_length", "m", 1e-5, 1e6,
                              "longest step; shadow detail along the ray needs short ones",
                              TYNDALL_FIELD(march.step_length)));
    rows.push_back(number_row("march.step_share", "", 1e-5, 1,
                              "longest step as a share of the ray's stretch through fog",
                              TYNDALL_FIELD(march.step_share)));
    rows.push_back(number_row("march.near_light", "", 0.005, 10,
                              "a step is at most this share of the distance to a local light, and an eighth "
                              "of it of the way through the beam of a spot",
                              TYNDALL_FIELD(march.near_light)));
    rows.push_back(number_row("march.max_steps", "", 1, 1e6,
                              "most steps per ray; they get longer beyond (exact takes all it needs)",
                              TYNDALL_FIELD(march.max_steps)));
    rows.push_back(number_row("march.min_transmittance", "", 0, 0.5, "the march ends where less than this share passes",
                              TYNDALL_FIELD(march.min_transmittance)));
    rows.push_back(choice_row("march.visibility", {"off", "rays", "maps", "slices", "exact"},
                              "shadows of surfaces in the fog; slices = only lit stretches are marched, found without "
                              "sampling (by rays where surfaces have alpha, or more than "
                              "200000 triangles and soft lights); rays = sampled at each step; maps = the "
                              "same, looked up in shadow_map.*; exact = as slices, and everything else integrated as "
                              "exactly as the fog allows: the reference",
                              TYNDALL_FIELD(march.visibility)));
    rows.push_back(number_row("march.nodes", "", 1, 16,
                              "Gauss-Legendre nodes on each lit stretch of fog without a grid, with slices",
                              TYNDALL_FIELD(march.nodes)));
    rows.push_back(
        choice_row("march.light", {"off", "average", "froxel", "grid", "marched"},
                   "fog between light and fog; froxel = looked up in a grid before the camera, grid = in one "
                   "before each light, marched = exact at every point",
                   TYNDALL_FIELD(march.light)));
    rows.push_back(number_row("march.light_resolution", "cells", 4, 1024,
                              "cells across the fog in the light's grid; with froxel, across the picture and in depth",
                              TYNDALL_FIELD(march.light_resolution)));
    rows.push_back(number_row(
        "march.light_points", "", 1, 256,
        "points of a soft light that shadows are asked for, by each ray (slices, exact) or step (rays) and by each "
        "sample of a surface",
        TYNDALL_FIELD(march.light_points)));
    rows.push_back(choice_row("march.phase", switches, "directional scattering; off = the same in all directions",
                              TYNDALL_FIELD(march.phase)));
    rows.push_back(choice_row("march.heterogeneity", switches, "density detail; off = every grid at its mean density",
                              TYNDALL_FIELD(march.heterogeneity)));
    rows.push_back(
        choice_row("march.emission", switches, "light the fog itself gives off", TYNDALL_FIELD(march.emission)));
    rows.push_back(
        choice_row("march.ambient", switches, "the scene's ambient light in the fog", TYNDALL_FIELD(march.ambient)));
}
}
