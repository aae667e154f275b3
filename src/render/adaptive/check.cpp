#include "render/adaptive/check.h"

#include "modes/mode.h"
#include "render/adaptive/chooser.h"

#include <algorithm>
#include <ranges>

namespace tyndall {
namespace {
constexpr double max_doubt_share = 0.25; // of the main mode's work, to measure another mode's image further

// Whether `wanted` lies within the uncertainty of a squared error: above its lower bound but below its upper one.
bool is_undecided(const SquaredError& error, double wanted) {
    return error.bound > wanted && 2 * error.value - error.bound <= wanted;
}

// A finer candidate, if starting over with it takes less work than `least`, among those up to the first that leaves
// room for noise; otherwise the choice itself.
Choice finer_than(const Choice& choice, const Chooser& chooser, const std::shared_ptr<Pilot>& pilot, double least) {
    const double error = chooser.goal.error;
    Choice result = choice;
    auto next = std::ranges::find(chooser.candidates, choice.candidate.name, &Candidate::name);
    while (next != chooser.candidates.end() && ++next != chooser.candidates.end()) {
        PilotRun run = chooser.start_run(*next, choice.scout.get());
        Choice finer = chooser.choice(*next, run, pilot, &choice, choice.scout);
        const bool room = leaves_room(finer, error);
        const double work = finer.work_to(error);
        if (work < least || (least == infinity && room)) least = work, result = std::move(finer);
        if (room) break;
    }
    return result;
}
}

Choice check_choice(const Choice& choice, const CheckedImage& picture, double until, const Mode& mode, const View& view,
                    const Snapshot& snapshot, const Settings& settings, const Goal& goal, uint32_t salt,
                    const FrameOptions& options) {
    if (!choice.has_integrator || choice.is_truth) return choice;
    const Chooser chooser{mode, view, snapshot, settings, goal, options};
    const bool is_bound = overrides_candidates(mode, settings, goal.quality);
    const double squared_goal = goal.error * goal.error, squared_noise = picture.noise.bound * picture.noise.bound;
    // If the integrator alone misses the goal, measure by how much on all the tiles of a drawing, however few samples
    // the image has.
    const bool hopeless = choice.measured.integrator.bound >= squared_goal;
    const auto chances = [&] {
        if (picture.layers.variance.empty()) return uniform_chances(view, snapshot);
        return choice.from_contest ? chances_between(picture.layers, choice.scout->layers) : chances_in(picture.layers);
    };
    const std::shared_ptr<Pilot> pilot = chooser.pilot(
        chances(), salt, choice.pilot ? choice.pilot->prepared : nullptr, [&] { return goal.clock() > until; },
        hopeless ? double{infinity} : picture.samples * choice.measured.sample_work);
    pilot->stop = {}; // it captures locals of this call
    Choice result = choice;
    PilotRun run{mode, choice.candidate.settings, choice.measured.prepared};
    SquaredError& integrator = result.measured.integrator;
    const Measurement first = measure(*pilot, run, goal.clock);
    integrator = first.integrator;

    const double begun = pilot->cost.work, work = picture.samples * first.sample_work;
    const auto work_left = [&](double squared_integrator) {
        const double all = work * choice.times_to(goal.error, squared_integrator, picture.noise);
        return std::max(all - picture.done * first.sample_work, 0.0);
    };
    // If in doubt, measure further as long as that takes less work than the alternatives: more samples, a finer
    // candidate of the main mode (about the work of this one), or a share of the work of another mode's image. Noise
    // would leave as much doubt about a finer candidate, so then only that limit counts, not what measuring may save.
    const auto see_more = [&] {
        const double spent = pilot->cost.work - begun, again = pilot->cost.work;
        double least = std::min(work_left(integrator.bound), max_doubt_share * goal.other_work);
        const bool or_finer = mode.name == main_mode().name && !is_bound && work < least;
        if (or_finer) least = work;
        const bool by_noise = pilot->can_grow(integrator.by_noise) ? integrator.by_noise : !integrator.by_noise;
        const bool worth = or_finer && by_noise ? spent + again <= work
                                                : worth_seeing(integrator, *pilot, least - spent, again, work_left);
        if (!pilot->can_grow(by_noise) || !worth) return false;
        grow(*pilot, by_noise);
        return true;
    };
    const auto is_in_time = [&] { return goal.seconds == 0 || goal.clock() + pilot->cost.seconds < until; };
    while (squared_noise < squared_goal && is_undecided(integrator, squared_goal - squared_noise) && is_in_time() &&
           see_more())
        integrator = measure(*pilot, run, goal.clock).integrator;

    const bool missed = integrator.bound + squared_noise > squared_goal;
    if (!missed || goal.error == 0 || goal.seconds > 0 || is_bound || !picture.may_restart) return result;
    if (choice.from_contest) return result; // the main mode is likely to be faster than a finer candidate
    return finer_than(result, chooser, pilot, std::min(work_left(integrator.bound), goal.other_work));
}
}
