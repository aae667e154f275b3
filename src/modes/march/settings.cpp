// Settings of the main renderer: rows, presets, and the ladder from quick to careful.
#include "modes/march/settings.h"
#include "modes/mode.h"
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

void set_march_quality(Settings& settings, Quality quality) {
    MarchSettings& march = settings.march;
    switch (quality) {
    case Quality::draft:
        march.step_depth = 0.5f, march.step_voxels = 16, march.step_share = 1.0f / 24, march.near_light = 1;
        march.min_transmittance = 1e-2f, march.light_resolution = 32, march.light = LightTransmittance::froxel;
        march.nodes = 3;
        break;
    case Quality::preview:
        break;
    case Quality::final:
        march.step_depth = 0.1f, march.step_voxels = 2, march.step_share = 1.0f / 96, march.near_light = 0.25f;
        march.max_steps = 4096, march.min_transmittance = 1e-4f, march.light_resolution = 128, march.nodes = 6;
        break;
    case Quality::reference:
        march.step_depth = 0.1f, march.step_voxels = 2, march.step_share = 1.0f / 64, march.near_light = 0.02f;
        march.max_steps = 65536, march.min_transmittance = 0, march.light = LightTransmittance::marched;
        march.visibility = Visibility::exact;
        march.light_resolution = 256, march.nodes = 16;
        break;
    }
}

namespace {
// What a rung decides.
constexpr std::array<std::string_view, 10> rung_rows{
    "march.step_depth",        "march.step_voxels", "march.step_share", "march.near_light", "march.max_steps",
    "march.min_transmittance", "march.visibility",  "march.light",      "march.nodes",      "march.light_resolution"};

Rung rung_of(std::string name, int samples, const MarchSettings& march) {
    Settings settings;
    settings.march = march;
    Rung rung{std::move(name), "pixel.samples=" + std::to_string(samples)};
    std::vector<SettingRow> rows;
    append_march_rows(rows);
    for (const SettingRow& row : rows)
        if (std::ranges::count(rung_rows, row.name)) rung.assignments += " " + row.name + "=" + row.get(settings);
    return rung;
}
}

// Steps and light grids get finer together, since neither alone is the whole error; samples grow with care, so that the
// edges of surfaces do not hide what the fog gains.
std::vector<Rung> march_rungs() {
    const auto of = [](Quality quality) {
        Settings settings;
        set_march_quality(settings, quality);
        return settings.march;
    };
    MarchSettings fine = of(Quality::preview), finer = of(Quality::final), marched;
    fine.step_depth = 0.15f, fine.step_voxels = 4, fine.step_share = 1.0f / 56, fine.near_light = 0.35f;
    fine.max_steps = 2048, fine.min_transmittance = 3e-4f, fine.light_resolution = 96, fine.nodes = 5;
    finer.step_depth = 0.05f, finer.step_voxels = 1, finer.step_share = 1.0f / 192, finer.near_light = 0.125f;
    finer.max_steps = 16384, finer.min_transmittance = 1e-5f, finer.light_resolution = 256, finer.nodes = 8;
    marched = finer, marched.light = LightTransmittance::marched;
    return {rung_of("draft", 1, of(Quality::draft)),
            rung_of("preview", 1, of(Quality::preview)),
            rung_of("fine", 4, fine),
            rung_of("final", 16, of(Quality::final)),
            rung_of("finer", 32, finer),
            rung_of("marched", 64, marched),
            rung_of("exact", 64, of(Quality::reference))};
}
}
