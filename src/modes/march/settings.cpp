// Settings of march: rows, presets, and the ladder from fastest to most accurate.
#include "modes/march/settings.h"
#include "modes/mode.h"
#include "modes/settings_rows.h"

namespace tyndall {
void append_march_rows(std::vector<SettingRow>& rows) {
    rows.push_back(number_row("march.step_depth", "", 1e-4, 10, "maximum optical depth per step",
                              TYNDALL_FIELD(march.step_depth)));
    rows.push_back(number_row("march.step_voxels", "voxels", 0.05, 64, "maximum length of a step in voxels",
                              TYNDALL_FIELD(march.step_voxels)));
    rows.push_back(number_row("march.step_share", "", 1e-5, 1,
                              "maximum length of a step, as a fraction of the ray's length in fog",
                              TYNDALL_FIELD(march.step_share)));
    rows.push_back(number_row("march.near_light", "", 0.005, 10,
                              "maximum length of a step, as a fraction of the distance to a local light; where "
                              "visibility is sampled, in a spot's beam also an eighth of this fraction of the length "
                              "inside it",
                              TYNDALL_FIELD(march.near_light)));
    rows.push_back(number_row("march.min_transmittance", "", 0, 0.5,
                              "marching stops where transmittance falls below this",
                              TYNDALL_FIELD(march.min_transmittance)));
    rows.push_back(choice_row(
        "march.visibility", {"off", "rays", "maps", "intervals", "exact"},
        "shadows of surfaces in the fog; intervals = integrated over the lit intervals of each ray, found without "
        "sampling (by rays for surfaces with alpha, for more than 2 million triangles, and for more than 200000 with "
        "soft lights, a lens, or shadow volumes over 1 GiB); rays = sampled at each step; maps = looked up in shadow "
        "maps at each step (shadow_map.*); exact = like intervals, with everything else integrated as exactly as the "
        "fog allows: the reference",
        TYNDALL_FIELD(march.visibility)));
    rows.push_back(number_row("march.nodes", "", 1, 16,
                              "with intervals: Gauss-Legendre nodes on each lit interval of fog without a grid",
                              TYNDALL_FIELD(march.nodes)));
    rows.push_back(number_row("march.light_marches", "", 0, 65536,
                              "with exact: number of nodes per ray and light, resampled by contribution, from which "
                              "transmittance to the light is marched through grids and alpha; 0 = all nodes",
                              TYNDALL_FIELD(march.light_marches)));
    mark_advanced(rows, {"step_voxels", "near_light", "min_transmittance", "light_marches"});
}

void set_march_quality(Settings& settings, Quality quality) {
    MarchSettings& march = settings.march;
    switch (quality) {
    case Quality::draft:
        march.step_depth = 0.5f, march.step_voxels = 16, march.step_share = 1.0f / 24, march.near_light = 1;
        march.min_transmittance = 1e-2f, march.nodes = 3;
        break;
    case Quality::preview:
        break;
    case Quality::final:
        march.step_depth = 0.1f, march.step_voxels = 2, march.step_share = 1.0f / 96, march.near_light = 0.25f;
        march.min_transmittance = 1e-4f, march.nodes = 6;
        break;
    case Quality::reference:
        march.step_depth = 0.1f, march.step_voxels = 2, march.step_share = 1.0f / 64, march.near_light = 0.02f;
        march.min_transmittance = 0, march.visibility = Visibility::exact, march.nodes = 16;
        break;
    }
}

namespace {
// Rows that a rung sets.
constexpr std::array<std::string_view, 9> rung_rows{
    "march.step_depth", "march.step_voxels", "march.step_share", "march.near_light",      "march.min_transmittance",
    "march.visibility", "march.nodes",       "terms.light",      "terms.light_resolution"};

Rung rung_of(std::string name, int samples, const Settings& settings) {
    Rung rung{std::move(name), "pixel.samples=" + std::to_string(samples)};
    std::vector<SettingRow> rows;
    append_march_rows(rows), append_term_rows(rows);
    for (const SettingRow& row : rows)
        if (std::ranges::count(rung_rows, row.name)) rung.assignments += " " + row.name + "=" + row.get(settings);
    return rung;
}
}

// Steps and light grids are refined together, as each is only part of the error; pixel samples grow with them, so that
// the edges of surfaces do not hide the gain in the fog.
std::vector<Rung> march_rungs() {
    const auto of = [](Quality quality) {
        Settings settings;
        set_term_quality(settings.terms, quality), set_march_quality(settings, quality);
        return settings;
    };
    Settings fine = of(Quality::preview), finer = of(Quality::final);
    fine.march.step_depth = 0.15f, fine.march.step_voxels = 4, fine.march.step_share = 1.0f / 56;
    fine.march.near_light = 0.35f, fine.march.min_transmittance = 3e-4f, fine.march.nodes = 5;
    fine.terms.light_resolution = 96;
    finer.march.step_depth = 0.05f, finer.march.step_voxels = 1, finer.march.step_share = 1.0f / 192;
    finer.march.near_light = 0.125f, finer.march.min_transmittance = 1e-5f, finer.march.nodes = 8;
    finer.terms.light_resolution = 256;
    Settings marched = finer;
    marched.terms.light = LightTransmittance::marched;
    return {rung_of("draft", 1, of(Quality::draft)),
            rung_of("preview", 1, of(Quality::preview)),
            rung_of("fine", 4, fine),
            rung_of("final", 16, of(Quality::final)),
            rung_of("finer", 32, finer),
            rung_of("marched", 64, marched),
            rung_of("exact", 64, of(Quality::reference))};
}
}
