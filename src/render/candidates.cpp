#include "render/candidates.h"

#include "modes/techniques.h"

#include <algorithm>
#include <array>

namespace tyndall {
namespace {
// What a candidate decides.
constexpr std::array<std::string_view, 10> chosen_rows{
    "march.step_depth",        "march.step_voxels", "march.step_share", "march.near_light", "march.max_steps",
    "march.min_transmittance", "march.visibility",  "march.light",      "march.nodes",      "march.light_resolution"};

// The rows of `from` in `to`, but for those in which `settings` departs from `usual`.
void take_rows(const Settings& from, const Settings& settings, const Settings& usual, Settings& to) {
    for (const SettingRow& row : setting_rows())
        if (std::ranges::count(chosen_rows, row.name) && row.get(settings) == row.get(usual))
            row.set(to, row.get(from));
}

struct Rung {
    const char* name;
    MarchSettings march;
};

// Steps and light grids get finer together, since neither alone is the whole error.
std::vector<Rung> march_rungs() {
    const auto of = [](Quality quality) { return settings_for(quality).march; };
    MarchSettings fine = of(Quality::preview), finer = of(Quality::final), marched;
    fine.step_depth = 0.15f, fine.step_voxels = 4, fine.step_share = 1.0f / 56, fine.near_light = 0.35f;
    fine.max_steps = 2048, fine.min_transmittance = 3e-4f, fine.light_resolution = 96, fine.nodes = 5;
    finer.step_depth = 0.05f, finer.step_voxels = 1, finer.step_share = 1.0f / 192, finer.near_light = 0.125f;
    finer.max_steps = 16384, finer.min_transmittance = 1e-5f, finer.light_resolution = 256, finer.nodes = 8;
    marched = finer, marched.light = LightTransmittance::marched;
    return {{"draft", of(Quality::draft)},
            {"preview", of(Quality::preview)},
            {"fine", fine},
            {"final", of(Quality::final)},
            {"finer", finer},
            {"marched", marched},
            {"exact", of(Quality::reference)}};
}
}

bool has_integrator(const Mode& mode) { return mode.prepare == prepare_march; }

bool error_can_be_told(const Mode& mode) { return error_is_noise(mode) || has_integrator(mode); }

std::vector<Candidate> candidates_of(const Mode& mode, const Settings& settings, Quality quality) {
    if (error_is_noise(mode)) return {{"", settings}};
    if (!has_integrator(mode)) return {};
    const Settings usual = settings_for(quality);
    std::vector<Candidate> candidates;
    for (const Rung& rung : march_rungs()) {
        Settings from, to = settings;
        from.march = rung.march;
        take_rows(from, settings, usual, to);
        candidates.push_back({rung.name, to});
    }
    return candidates;
}

bool binds_candidates(const Settings& settings, Quality quality) {
    const Settings usual = settings_for(quality);
    return std::ranges::any_of(setting_rows(), [&](const SettingRow& row) {
        return std::ranges::count(chosen_rows, row.name) && row.get(settings) != row.get(usual);
    });
}

Settings truth_of(const Settings& settings) {
    Settings truth = settings;
    take_rows(settings_for(Quality::reference), settings, settings, truth);
    return truth;
}
}
