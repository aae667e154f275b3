#include "render/adaptive/goal.h"

#include "base/clock.h"
#include "modes/mode.h"
#include "render/adaptive/chooser.h"
#include "render/adaptive/errors/orders.h"

#include <algorithm>
#include <list>
#include <ranges>

namespace tyndall {
namespace {
// Shares of the time limit that measuring may take.
constexpr double truth_share = 0.1, measuring_share = 0.4, scout_share = 0.2;
constexpr double max_orders_share = 0.15; // of the time limit, to measure multiple scattering

// Whether a finer candidate is no more accurate than the one before.
bool gains_nothing(const Choice& next, const Choice& before) {
    return next.measured.integrator.value > 0.9 * before.measured.integrator.value;
}

bool reaches(const Choice& choice, double samples, double error) {
    const double noise = choice.expected(samples) - choice.measured.integrator.value;
    return leaves_room(choice, error) && choice.measured.integrator.bound + noise <= error * error;
}

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
}
