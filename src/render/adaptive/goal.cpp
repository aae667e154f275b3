#include "render/adaptive/goal.h"

#include "base/clock.h"
#include "modes/mode.h"
#include "render/adaptive/orders.h"

#include <algorithm>
#include <list>
#include <optional>
#include <ranges>

namespace tyndall {
namespace {
// Shares of the time limit that measuring may take.
constexpr double truth_share = 0.1, measuring_share = 0.4, scout_share = 0.2;
constexpr double truth_work_share = 0.2;  // of the image's work, without a time limit
constexpr double max_orders_share = 0.15; // of the time limit, to measure multiple scattering
constexpr double max_doubt_share = 0.25;  // of the main mode's work, to measure another mode's image further
constexpr int truth_marches = 64;         // nodes along a ray from which the ground truth marches to each light

// Whether a finer candidate is no more accurate than the one before.
bool gains_nothing(const Choice& next, const Choice& before) {
    return next.measured.integrator.value > 0.9 * before.measured.integrator.value;
}

bool reaches(const Choice& choice, double samples, double error) {
    const double noise = choice.expected(samples) - choice.measured.integrator.value;
    return leaves_room(choice, error) && choice.measured.integrator.bound + noise <= error * error;
}

// Whether `wanted` lies within the uncertainty of a squared error: above its lower bound but below its upper one.
bool is_undecided(const SquaredError& error, double wanted) {
    return error.bound > wanted && 2 * error.value - error.bound <= wanted;
}

// Whether measuring an integrator's error further is likely to cost less than it saves of `least`, the work otherwise
// needed. Repeating the measurement so far costs `again`; `to_goal` is the remaining work for a given squared error. If
// the uncertainty is due to noise, bound - value falls as 1 / passes, since means over passes are multiplied; if it is
// due to few tiles, it falls like a standard error. The value itself may turn out smaller: a measurement that could
// save many times its cost is worthwhile.
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

bool same_settings(const Settings& a, const Settings& b) {
    return std::ranges::all_of(setting_rows(), [&](const SettingRow& row) { return row.get(a) == row.get(b); });
}

// Inputs for choosing among a mode's candidates.
struct Chooser {
    const Mode& mode;
    const View& view;
    const Snapshot& snapshot;
    const Settings& settings;
    const Goal& goal;
    const FrameOptions& options;
    std::vector<Candidate> candidates = candidates_of(mode, settings, goal.quality);
    bool systematic = has_integrator(mode);
    Settings truth = systematic ? truth_settings(goal.wanted ? *goal.wanted : settings) : settings;

    // `work`: of the image that the pilot is for.
    std::shared_ptr<Pilot> pilot(TileChances chances, uint32_t salt, std::shared_ptr<const Prepared> ready,
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

    // Predicted work to reach the error with the scout's candidate if that had no integration error.
    double work_ahead(const Scout& scout) const {
        if (!(goal.error > 0)) return infinity;
        const AllotLimits limits{goal.error * goal.error, infinity};
        const double rays = allot(scout.layers, scout_samples, limits, 1, scout_samples).rays;
        return scout.work() * std::max(rays / static_cast<double>(scout.stats.camera_rays), 1.0);
    }

    PilotRun start_run(const Candidate& candidate, const Scout* scout) const {
        const bool scouted = scout && scout->candidate.name == candidate.name;
        PilotRun run{mode, candidate.settings, scouted ? scout->prepared : nullptr};
        if (scouted) run.prepare_seconds = scout->prepare_seconds;
        return run;
    }

    // Measures a candidate. `before` is one already measured, if any: its variance power and pace are reused.
    Choice choice(const Candidate& candidate, PilotRun& run, std::shared_ptr<Pilot> pilot, const Choice* before,
                  std::shared_ptr<const Scout> scout) const {
        const bool scouted = scout && scout->candidate.name == candidate.name;
        Choice choice{candidate, measure(*pilot, run, goal.clock), systematic};
        choice.scout = scout, choice.power = before ? before->power : 1, choice.pace = before ? before->pace : 1;
        choice.is_truth = mode.name == main_mode().name && same_settings(candidate.settings, truth);
        if (choice.is_truth) choice.measured.integrator = {};
        if (scouted) choice.pace = scout->seconds / scout_samples / std::max(choice.measured.sample_seconds, 1e-9);
        choice.measured.sample_seconds *= choice.pace;
        if (systematic && !before)
            choice.power = variance_power(*pilot, mode, candidate.settings, *choice.measured.prepared);
        choice.pilot = std::move(pilot);
        choice.scout_variance = before ? before->scout_variance : choice.measured.sample.value;
        return choice;
    }
};

// Renders a scout unless the mode's only error is noise or the scout would take too much of the time limit. `sample`
// receives the variance of one sample if that decision required measuring it.
std::shared_ptr<const Scout> scout_for(const Chooser& chooser, double start, SquaredError& sample) {
    const auto& [mode, view, snapshot, settings, goal, options, candidates, systematic, truth] = chooser;
    if (!systematic) return nullptr;
    std::shared_ptr<const Prepared> prepared;
    double prepare_seconds = 0;
    if (goal.seconds > 0) {
        Pilot first = make_pilot(mode, view, snapshot, nullptr, uniform_chances(view, snapshot), 0, options);
        grow(first);
        const Measurement coarse = measure(first, mode, candidates[0].settings, goal.clock);
        const double left = goal.seconds - (goal.clock() - start);
        sample = coarse.sample;
        if (scout_samples * coarse.sample_seconds > scout_share * left) return nullptr;
        prepared = coarse.prepared, prepare_seconds = coarse.prepare_seconds;
    }
    std::shared_ptr<const Scout> scout =
        make_scout(mode, view, snapshot, candidates[0], options, goal.clock, std::move(prepared));
    if (prepare_seconds == 0) return scout;
    auto known = std::make_shared<Scout>(*scout);
    known->prepare_seconds = prepare_seconds;
    return known;
}
}

OrdersError orders_error_for(const Goal& goal, const Mode& mode, const View& view, const Snapshot& snapshot,
                             const Settings& settings, const FrameOptions& options) {
    std::function<bool()> stop;
    if (goal.seconds > 0)
        stop = [&goal, start = goal.clock()] { return goal.clock() - start > max_orders_share * goal.seconds; };
    return orders_error(mode, view, snapshot, settings, goal.error, options, stop);
}

std::optional<OrdersError> measure_orders(const Mode& mode, const View& view, const Snapshot& snapshot,
                                          const Settings& settings, Goal& goal, const FrameOptions& options) {
    if (!takes_fluence(mode, settings)) return {};
    const OrdersError orders =
        goal.orders ? *goal.orders : orders_error_for(goal, mode, view, snapshot, settings, options);
    if (goal.error > 0)
        goal.error = remaining_error(orders.pixels, goal.error).value_or(goal.error); // none = goal missed
    return orders;
}

namespace {
// A candidate, its measurement, and the work to reach the error: by the bound of its integrator error (`sure`) and by
// the estimate itself (`hoped`).
struct Entry {
    const Candidate& candidate;
    PilotRun run;
    Choice choice;
    double sure = infinity, hoped = infinity;

    void weigh(double error) {
        sure = choice.work_to(error), hoped = choice.work_to(error, choice.measured.integrator.value);
    }
};

// The candidate with the least work. The pilot grows as long as another candidate may save more than that costs, or
// none seems to reach the error and too little was measured to be certain; if it shows that none leaves room for noise,
// finer candidates are measured too.
Choice choose_by_work(const Chooser& chooser, const std::shared_ptr<Pilot>& pilot,
                      const std::shared_ptr<const Scout>& scout) {
    const double error = chooser.goal.error;
    const bool bound = overrides_candidates(chooser.mode, chooser.settings, chooser.goal.quality);
    std::list<Entry> entries;
    std::optional<Choice> before; // of the finest so far
    size_t next = 0;
    while (true) {
        while (entries.empty() || (next < chooser.candidates.size() && !leaves_room(entries.back().choice, error))) {
            const Candidate& candidate = chooser.candidates[next++];
            PilotRun run = chooser.start_run(candidate, scout.get());
            Choice choice = chooser.choice(candidate, run, pilot, before ? &*before : nullptr, scout);
            if (before && bound && gains_nothing(choice, *before)) {
                next = chooser.candidates.size();
                break;
            }
            before = choice, before->measured.prepared = nullptr;
            entries.push_back({candidate, std::move(run), std::move(choice)});
            entries.back().weigh(error);
        }
        const Entry& best = *std::ranges::min_element(std::ranges::reverse_view(entries), {}, &Entry::sure);
        const Entry& hoped = *std::ranges::min_element(entries, {}, &Entry::hoped);
        const Choice& doubtful = (hoped.hoped == infinity ? best : hoped).choice;
        const SquaredError& integrator = doubtful.measured.integrator;
        double again = pilot->cost.work;
        for (const Entry& entry : entries) again += entry.run.cost.work;
        const auto to_goal = [&](double squared) { return doubtful.work_to(error, squared); };
        if (!chooser.systematic || !pilot->can_grow(integrator.by_noise) ||
            !worth_seeing(integrator, *pilot, best.sure, again, to_goal))
            return best.choice;
        const double least = best.sure;
        grow(*pilot, integrator.by_noise);
        for (Entry& entry : entries) {
            if (entry.hoped > least) continue; // cannot win as long as the best candidate stays as good
            entry.choice = chooser.choice(entry.candidate, entry.run, pilot, &*before, scout);
            entry.weigh(error);
        }
    }
}
}

Choice choose(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings, const Goal& goal,
              double start, const FrameOptions& options) {
    const auto spent = [&] { return goal.clock() - start; };
    const Chooser chooser{mode, view, snapshot, settings, goal, options};
    SquaredError sample; // measured on more tiles than there may be time for with the ground truth
    const std::shared_ptr<const Scout> scout = scout_for(chooser, start, sample);
    const double piloting = spent();
    const std::shared_ptr<Pilot> pilot = chooser.pilot(
        scout ? chances_in(scout->layers) : uniform_chances(view, snapshot), 0, nullptr,
        [&] { return spent() - piloting > truth_share * goal.seconds; }, scout ? chooser.work_ahead(*scout) : infinity);
    pilot->stop = {}; // it captures locals of this call
    if (goal.seconds == 0) return choose_by_work(chooser, pilot, scout);

    std::optional<Choice> best;
    for (const Candidate& candidate : chooser.candidates) {
        const double begun = spent();
        PilotRun run = chooser.start_run(candidate, scout.get());
        Choice next = chooser.choice(candidate, run, pilot, best ? &*best : nullptr, scout);
        if (!scout && sample.value > 0) next.measured.sample = sample;
        const double now = spent();
        const auto samples = [&](const Choice& choice) {
            return std::max(1.0, std::floor((goal.seconds - now) / choice.measured.sample_seconds));
        };
        if (best && samples(next) < 2 && samples(*best) >= 2) break; // one sample has no noise estimate
        if (goal.error > 0 && reaches(next, samples(next), goal.error)) return next;
        const double expected = next.expected(samples(next));
        const bool noisy = expected > 11 * next.measured.integrator.value;
        if (!best || expected < best->expected(samples(*best))) best = std::move(next);
        // A finer candidate gains nothing if noise dominates, and takes longer to prepare than this one did.
        if (noisy || now + 3 * (now - begun) > measuring_share * goal.seconds) break;
    }
    return std::move(*best);
}

namespace {
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
    // candidate of the main mode (about the work of this one), or a share of the work of another mode's image.
    const auto see_more = [&] {
        const bool has_finer = mode.name == main_mode().name && !is_bound;
        double least = std::min(work_left(integrator.bound), max_doubt_share * goal.other_work);
        if (has_finer) least = std::min(least, work);
        const bool by_noise = pilot->can_grow(integrator.by_noise) ? integrator.by_noise : !integrator.by_noise;
        least -= pilot->cost.work - begun;
        if (!pilot->can_grow(by_noise) || !worth_seeing(integrator, *pilot, least, pilot->cost.work, work_left))
            return false;
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
