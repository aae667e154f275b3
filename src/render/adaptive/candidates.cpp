#include "render/adaptive/candidates.h"
#include "modes/mode.h"

#include <algorithm>

namespace tyndall {
namespace {
// Rows of a mode's ladder in which the settings are as their quality says.
std::vector<std::string> free_rows(const Mode& mode, const Settings& settings, Quality quality) {
    const Settings usual = settings_for(quality);
    std::vector<std::string> names = ladder_rows(mode);
    std::erase_if(names, [&](const std::string& name) {
        const auto row = std::ranges::find(setting_rows(), name, &SettingRow::name);
        return row->get(settings) != row->get(usual);
    });
    return names;
}
}

bool has_integrator(const Mode& mode) {
    return mode.accuracy != Accuracy::artistic && !error_is_noise(mode) && !ladder_rows(mode).empty();
}

bool error_can_be_told(const Mode& mode) { return error_is_noise(mode) || has_integrator(mode); }

std::vector<Candidate> candidates_of(const Mode& mode, const Settings& settings, Quality quality) {
    if (error_is_noise(mode)) return {{"", settings}};
    if (!has_integrator(mode)) return {};
    const std::vector<std::string> rows = free_rows(mode, settings, quality);
    std::vector<Candidate> candidates;
    for (const Candidate& rung : ladder_of(mode, settings)) {
        candidates.push_back({rung.name, settings});
        take_rows(rows, rung.settings, candidates.back().settings);
    }
    return candidates;
}

bool binds_candidates(const Mode& mode, const Settings& settings, Quality quality) {
    return free_rows(mode, settings, quality).size() < ladder_rows(mode).size();
}

Settings truth_of(const Settings& settings) {
    Settings truth = settings;
    take_rows(ladder_rows(main_mode()), settings_for(Quality::reference), truth);
    return truth;
}
}
