#include "render/adaptive/goal.h"
#include "modes/mode.h"

#include <algorithm>
#include <optional>

namespace tyndall {
namespace {
// Shares of the time that measuring may take.
constexpr double truth_share = 0.1, measuring_share = 0.4;

bool leaves_room(const Choice& choice, double error) {
    return choice.measured.integrator.bound <= std::pow(integrator_share * error, 2);
}

// Whether a finer candidate is as wrong as the one before.
bool gains_nothing(const Choice& next, const Choice& before) {
    return next.measured.integrator.value > 0.9 * before.measured.integrator.value;
}

bool reaches(const Choice& choice, double samples, double error) {
    const Measured& m = choice.measured;
    const double bound = samples < 2 ? m.single.bound : m.integrator.bound + m.sample.bound / samples;
    return leaves_room(choice, error) && bound <= error * error;
}
}

double Choice::expected(double samples) const {
    if (samples < 2) return measured.single.value;
    return measured.integrator.value + measured.sample.value / std::pow(samples, power);
}

Choice choose(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings, const Goal& goal,
              double start, const FrameOptions& options) {
    const bool timed = goal.seconds > 0, systematic = has_integrator(mode);
    const auto spent = [&] { return goal.clock() - start; };
    const Settings truth = systematic ? truth_of(goal.wanted ? *goal.wanted : settings) : settings;
    const Pilot pilot = make_pilot(systematic ? main_mode() : mode, view, snapshot, systematic ? &truth : nullptr,
                                   options, [&] { return timed && spent() > truth_share * goal.seconds; });

    // Noise falls alike for all candidates: it is mostly that of edges.
    double power = 0;
    const auto measured = [&](const Candidate& candidate) {
        Choice choice{candidate, measure(pilot, mode, snapshot, candidate.settings, options, goal.clock), systematic};
        if (power == 0)
            power = systematic ? spread_power(pilot, mode, snapshot, candidate.settings, *choice.measured.prepared,
                                              choice.measured.sample.value, options)
                               : 1;
        choice.power = power, choice.truth_seconds = pilot.truth_seconds;
        return choice;
    };

    std::optional<Choice> best;
    const std::vector<Candidate> candidates = candidates_of(mode, settings, goal.quality);
    for (const Candidate& candidate : candidates) {
        const double begun = spent();
        Choice next = measured(candidate);
        if (!timed) {
            if (leaves_room(next, goal.error)) return next;
            if (best && binds_candidates(mode, settings, goal.quality) && gains_nothing(next, *best)) break;
            best = std::move(next);
            continue;
        }
        const double now = spent();
        const auto samples = [&](const Choice& choice) {
            return std::max(1.0, std::floor((goal.seconds - now) / choice.measured.sample_seconds));
        };
        if (goal.error > 0 && reaches(next, samples(next), goal.error)) return next;
        const bool noisy = next.measured.sample.value / samples(next) > 10 * next.measured.integrator.value;
        if (!best || next.expected(samples(next)) < best->expected(samples(*best))) best = std::move(next);
        // A finer one gains nothing where noise rules, and takes longer to prepare than this one did.
        if (noisy || now + 3 * (now - begun) > measuring_share * goal.seconds) break;
    }
    return std::move(*best);
}
}
