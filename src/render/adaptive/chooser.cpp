#include "render/adaptive/chooser.h"

#include "modes/mode.h"

#include <algorithm>
#include <ranges>

namespace tyndall {
namespace {
constexpr double truth_work_share = 0.2; // of the image's work, without a time limit
constexpr int truth_marches = 64;        // nodes along a ray from which the ground truth marches to each light
}

std::shared_ptr<Pilot> Chooser::pilot(TileChances chances, uint32_t salt, std::shared_ptr<const Prepared> ready,
                                      std::function<bool()> stop, double work) const {
    if (goal.seconds == 0) stop = {};
    // Modes that omit effects may be wrong in only a few places: they get all the tiles of a drawing.
    if (goal.seconds > 0 || mode.name != main_mode().name) work = infinity;
    Settings quick = truth; // with the same expected value
    quick.march.light_marches = truth_marches;
    return std::make_shared<Pilot>(make_pilot(systematic ? main_mode() : mode, view, snapshot,
                                              systematic ? &quick : nullptr, std::move(chances), salt, options,
                                              std::move(ready), std::move(stop), truth_work_share * work));
}

double Chooser::work_ahead(const Scout& scout) const {
    if (!(goal.error > 0)) return infinity;
    const AllotLimits limits{goal.error * goal.error, infinity};
    const double rays = allot(scout.layers, scout_samples, limits, 1, scout_samples).rays;
    return scout.ray_cost() * rays;
}

PilotRun Chooser::start_run(const Candidate& candidate, const Scout* scout) const {
    const bool scouted = scout && scout->candidate.name == candidate.name;
    PilotRun run{mode, candidate.settings, scouted ? scout->prepared : nullptr};
    if (scouted) run.prepare_seconds = scout->prepare_seconds;
    return run;
}

Choice Chooser::choice(const Candidate& candidate, PilotRun& run, std::shared_ptr<Pilot> pilot, const Choice* before,
                       std::shared_ptr<const Scout> scout) const {
    const bool scouted = scout && scout->candidate.name == candidate.name;
    Choice choice{candidate, measure(*pilot, run, goal.clock), systematic};
    choice.scout = scout, choice.power = before ? before->power : 1, choice.pace = before ? before->pace : 1;
    choice.is_truth = mode.name == main_mode().name && same_settings(candidate.settings, truth);
    if (choice.is_truth) choice.measured.integrator = {};
    if (scouted) choice.pace = scout->sample_seconds / std::max(choice.measured.sample_seconds, 1e-9);
    choice.measured.sample_seconds *= choice.pace;
    if (systematic && !before)
        choice.power = variance_power(*pilot, mode, candidate.settings, *choice.measured.prepared);
    choice.pilot = std::move(pilot);
    choice.scout_variance = before ? before->scout_variance : choice.measured.sample.value;
    return choice;
}

bool worth_seeing(const SquaredError& integrator, const Pilot& pilot, double least, double again,
                  const std::function<double(double)>& to_goal) {
    constexpr double much_more = 20;
    const auto& [value, bound, by_noise] = integrator;
    const double smallest = to_goal(std::max(2 * value - bound, 0.0));
    if (smallest == infinity) return false;
    if (least - smallest >= much_more * again) return true;
    const int seen = by_noise ? pilot.passes : pilot.drawings, all = by_noise ? max_passes : max_drawings;
    for (int count = by_noise ? 2 * seen : seen + 1; count <= all; count += by_noise ? count : 1) {
        const double times = static_cast<double>(count) / seen, cost = (times - 1) * again;
        if (cost >= least) return false;
        if (least - to_goal(value + (bound - value) / (by_noise ? times : std::sqrt(times))) > cost) return true;
    }
    return false;
}
}
