#include "render/adaptive/candidates.h"
#include "modes/mode.h"

#include <algorithm>
#include <iterator>
#include <sstream>

namespace tyndall {
namespace {
std::vector<Rung> rungs_of(const Mode& mode) { return mode.rungs ? mode.rungs() : std::vector<Rung>{}; }

// "name=value name=value", as words.
std::vector<std::string> assignments(const Rung& rung) {
    std::istringstream words(rung.assignments);
    return {std::istream_iterator<std::string>(words), {}};
}
}

void take_rows(std::span<const std::string> names, const Settings& from, Settings& to) {
    for (const SettingRow& row : setting_rows())
        if (std::ranges::count(names, row.name)) row.set(to, row.get(from));
}

std::vector<std::string> ladder_rows(const Mode& mode) {
    std::vector<std::string> names;
    for (const Rung& rung : rungs_of(mode))
        for (const std::string& assignment : assignments(rung)) {
            const std::string name = assignment.substr(0, assignment.find('='));
            if (name != "pixel.samples" && !std::ranges::count(names, name)) names.push_back(name);
        }
    return names;
}

std::vector<Candidate> ladder_of(const Mode& mode, const Settings& settings) {
    std::vector<Candidate> ladder;
    for (const Rung& rung : rungs_of(mode)) {
        Candidate candidate{rung.name, settings};
        for (const std::string& assignment : assignments(rung)) {
            apply_setting(candidate.settings, assignment);
            if (!rung.name.empty() || assignment.starts_with("pixel.samples")) continue;
            candidate.name += (candidate.name.empty() ? "" : " ") + assignment;
        }
        ladder.push_back(std::move(candidate));
    }
    return ladder;
}

namespace {
// Ladder rows that the settings leave at their quality's defaults.
std::vector<std::string> free_rows(const Mode& mode, const Settings& settings, Quality quality) {
    const Settings usual = settings_for(quality);
    std::vector<std::string> names = ladder_rows(mode);
    std::erase_if(names, [&](const std::string& name) {
        const SettingRow& row = find_row(name);
        return row.get(settings) != row.get(usual);
    });
    return names;
}
}

bool has_integrator(const Mode& mode) {
    return mode.accuracy != Accuracy::artistic && !is_unbiased(mode) && !ladder_rows(mode).empty();
}

bool has_error_bound(const Mode& mode) { return is_unbiased(mode) || has_integrator(mode); }

std::vector<Candidate> candidates_of(const Mode& mode, const Settings& settings, Quality quality) {
    if (is_unbiased(mode)) return {{"", settings}};
    if (!has_integrator(mode)) return {};
    const std::vector<std::string> rows = free_rows(mode, settings, quality);
    std::vector<Candidate> candidates;
    for (const Candidate& rung : ladder_of(mode, settings)) {
        candidates.push_back({rung.name, settings});
        take_rows(rows, rung.settings, candidates.back().settings);
    }
    return candidates;
}

bool overrides_candidates(const Mode& mode, const Settings& settings, Quality quality) {
    return free_rows(mode, settings, quality).size() < ladder_rows(mode).size();
}

Settings truth_settings(const Settings& settings) {
    Settings truth = settings;
    take_rows(ladder_rows(main_mode()), settings_for(Quality::reference), truth);
    return truth;
}
}
