#include "render/adaptive/ladders.h"

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
}
