#include "render/adaptive/goal.h"
#include "modes/mode.h"

#include <algorithm>
#include <cassert>
#include <optional>

namespace tyndall {
namespace {
// Shares of the time that measuring may take.
constexpr double truth_share = 0.1, measuring_share = 0.4, scout_share = 0.2;

// Whether a finer candidate is as wrong as the one before.
bool gains_nothing(const Choice& next, const Choice& before) {
    return next.measured.integrator.value > 0.9 * before.measured.integrator.value;
}

bool reaches(const Choice& choice, double samples, double error) {
    const double noise = choice.expected(samples) - choice.measured.integrator.value;
    return leaves_room(choice, error) && choice.measured.integrator.bound + noise <= error * error;
}

bool same_settings(const Settings& a, const Settings& b) {
    return std::ranges::all_of(setting_rows(), [&](const SettingRow& row) { return row.get(a) == row.get(b); });
}

// All that choosing among the candidates of a mode needs.
struct Chooser {
    const Mode& mode;
    const View& view;
    const Snapshot& snapshot;
    const Settings& settings;
    const Goal& goal;
    const FrameOptions& options;
    std::vector<Candidate> candidates = candidates_of(mode, settings, goal.quality);
    bool systematic = has_integrator(mode);
    Settings truth = systematic ? truth_of(goal.wanted ? *goal.wanted : settings) : settings;

    std::shared_ptr<Pilot> pilot(TileChances chances, uint32_t salt, std::shared_ptr<const Prepared> ready,
                                 std::function<bool()> stop) const {
        if (goal.seconds == 0) stop = {};
        return std::make_shared<Pilot>(make_pilot(systematic ? main_mode() : mode, view, snapshot,
                                                  systematic ? &truth : nullptr, std::move(chances), salt, options,
                                                  std::move(ready), std::move(stop)));
    }

    // Draws more tiles as long as `worth` says that a tighter bound would be.
    Measured measured(Look look, Pilot& pilot, const std::function<bool(const Measured&)>& worth) const {
        Measured result = measure(pilot, look, goal.clock);
        while (systematic && goal.error > 0 && pilot.can_grow(result.integrator.by_noise) && worth(result)) {
            grow(pilot, result.integrator.by_noise);
            result = measure(pilot, look, goal.clock);
        }
        return result;
    }

    // What a candidate is worth; before is one measured already, which knows how noise falls.
    Choice choice(const Candidate& candidate, std::shared_ptr<Pilot> tiles, const Choice* before,
                  std::shared_ptr<const Scout> scout) const {
        Pilot& pilot = *tiles;
        const bool scouted = scout && scout->candidate.name == candidate.name;
        Look look{mode, candidate.settings, scouted ? scout->prepared : nullptr};
        if (scouted) look.prepare_seconds = scout->prepare_seconds;
        Choice choice{candidate, {}, systematic};
        choice.scout = scout, choice.power = before ? before->power : 1, choice.pace = before ? before->pace : 1;
        const auto saves_time = [&](const Measured& measured) {
            if (goal.seconds > 0 || measured.integrator.value >= goal.error * goal.error) return false;
            choice.measured = measured;
            const double now = choice.work_to(goal.error);
            choice.measured.integrator.bound = measured.integrator.value;
            return now - choice.work_to(goal.error) >
                   pilot.cost.work / (measured.integrator.by_noise ? 1 : pilot.drawings);
        };
        choice.measured = measured(std::move(look), pilot, saves_time);
        choice.is_truth = mode.name == main_mode().name && same_settings(candidate.settings, truth);
        if (scouted) choice.pace = scout->seconds / scout_samples / std::max(choice.measured.sample_seconds, 1e-9);
        choice.measured.sample_seconds *= choice.pace;
        if (systematic && !before)
            choice.power = spread_power(pilot, mode, candidate.settings, *choice.measured.prepared);
        choice.pilot = std::move(tiles);
        choice.scout_variance = before ? before->scout_variance : choice.measured.sample.value;
        return choice;
    }
};

// Without a limit of time always; else where that leaves most of it. `sample` becomes the variance of one sample, where
// that was measured to find out.
std::shared_ptr<const Scout> scout_for(const Chooser& chooser, double start, SquaredError& sample) {
    const auto& [mode, view, snapshot, settings, goal, options, candidates, systematic, truth] = chooser;
    if (!systematic) return nullptr;
    std::shared_ptr<const Prepared> prepared;
    double prepare_seconds = 0;
    if (goal.seconds > 0) {
        Pilot first = make_pilot(mode, view, snapshot, nullptr, even_chances(view), 0, options);
        grow(first);
        const Measured coarse = measure(first, mode, candidates[0].settings, goal.clock);
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

bool leaves_room(const Choice& choice, double error) {
    return choice.measured.integrator.bound <= std::pow(integrator_share * error, 2);
}

Allotment Choice::spread(const Enough& enough, int unit) const {
    assert(scout);
    Enough of_scout = enough;
    of_scout.squared_error /= noise_ratio;
    Allotment result = allot(scout->layers, scout_samples, of_scout, power, unit);
    result.squared_error *= noise_ratio;
    return result;
}

double Choice::samples_to(double error) const {
    const double left = error * error - measured.integrator.bound;
    if (!(left > 0) || !scout) return infinity;
    const double pixels = static_cast<double>(scout->layers.size.x) * scout->layers.size.y;
    return spread({left, infinity}, scout_samples).rays / pixels;
}

double Choice::seconds_to(double error) const {
    return measured.prepare_seconds + samples_to(error) * measured.sample_seconds;
}

double Choice::work_to(double error) const { return samples_to(error) * measured.sample_work; }

double Choice::expected(double samples) const {
    if (samples < 2) return measured.integrator.value + measured.sample.value;
    if (!scout) return measured.integrator.value + measured.sample.value / std::pow(samples, power);
    const double pixels = static_cast<double>(scout->layers.size.x) * scout->layers.size.y;
    return measured.integrator.value + spread({0, samples * pixels}, scout_samples).squared_error;
}

Choice choose(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings, const Goal& goal,
              double start, const FrameOptions& options) {
    const bool timed = goal.seconds > 0;
    const auto spent = [&] { return goal.clock() - start; };
    const Chooser chooser{mode, view, snapshot, settings, goal, options};
    SquaredError sample; // on more tiles than the truth may have time for
    const std::shared_ptr<const Scout> scout = scout_for(chooser, start, sample);
    const double piloting = spent();
    const std::shared_ptr<Pilot> pilot =
        chooser.pilot(scout ? chances_in(scout->layers) : even_chances(view), 0, nullptr,
                      [&] { return spent() - piloting > truth_share * goal.seconds; });
    pilot->stop = {}; // it refers to this call

    std::optional<Choice> best;
    for (const Candidate& candidate : chooser.candidates) {
        const double begun = spent();
        Choice next = chooser.choice(candidate, pilot, best ? &*best : nullptr, scout);
        if (!timed) {
            if (best && binds_candidates(mode, settings, goal.quality) && gains_nothing(next, *best)) break;
            const bool room = leaves_room(next, goal.error);
            const bool better = !best || next.work_to(goal.error) <= best->work_to(goal.error);
            if (better) best = std::move(next);
            if (room) break;
            continue;
        }
        if (!scout && sample.value > 0) next.measured.sample = sample;
        const double now = spent();
        const auto samples = [&](const Choice& choice) {
            return std::max(1.0, std::floor((goal.seconds - now) / choice.measured.sample_seconds));
        };
        if (goal.error > 0 && reaches(next, samples(next), goal.error)) return next;
        const double expected = next.expected(samples(next));
        const bool noisy = expected > 11 * next.measured.integrator.value;
        if (!best || expected < best->expected(samples(*best))) best = std::move(next);
        // A finer one gains nothing where noise rules, and takes longer to prepare than this one did.
        if (noisy || now + 3 * (now - begun) > measuring_share * goal.seconds) break;
    }
    return std::move(*best);
}

double check_seconds(const Choice& choice) {
    if (!choice.has_integrator || choice.is_truth || !choice.pilot) return 0;
    const Pilot& pilot = *choice.pilot;
    const double own = choice.measured.sample_seconds * pilot.samples() / pilot.pixels();
    return (pilot.cost.seconds + own) / (pilot.drawings * pilot.passes);
}

Choice checked(const Choice& choice, const Layers& picture, const Noise& noise, double samples, double until,
               const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings, const Goal& goal,
               uint32_t salt, const FrameOptions& options) {
    if (!choice.has_integrator || choice.is_truth) return choice;
    const Chooser chooser{mode, view, snapshot, settings, goal, options};
    const bool shows_noise = !picture.variance.empty();
    const std::shared_ptr<Pilot> pilot =
        chooser.pilot(shows_noise ? chances_in(picture) : even_chances(view), salt,
                      choice.pilot ? choice.pilot->prepared : nullptr, [&] { return goal.clock() > until; });
    pilot->stop = {}; // it refers to this call
    Choice result = choice;
    const auto decides = [&](const Measured& measured) {
        const double left = goal.error * goal.error - noise.bound * noise.bound;
        return measured.integrator.value <= left && measured.integrator.bound > left;
    };
    result.measured.integrator =
        chooser.measured({mode, choice.candidate.settings, choice.measured.prepared}, *pilot, decides).integrator;
    const double bound = std::hypot(std::sqrt(result.measured.integrator.bound), noise.bound);
    if (bound <= goal.error || goal.error == 0 || goal.seconds > 0 || binds_candidates(mode, settings, goal.quality))
        return result;

    // More samples of this one, of which some are there, or a finer one from nothing.
    double work = result.work_to(goal.error) - samples * result.measured.sample_work;
    auto next = std::ranges::find(chooser.candidates, choice.candidate.name, &Candidate::name);
    while (next != chooser.candidates.end() && ++next != chooser.candidates.end()) {
        Choice finer = chooser.choice(*next, pilot, &choice, choice.scout);
        const bool room = leaves_room(finer, goal.error);
        const double its_work = finer.work_to(goal.error);
        if (its_work < work || (work == infinity && room)) work = its_work, result = std::move(finer);
        if (room) break;
    }
    return result;
}
}
