#include "render/adaptive/contest.h"

#include "modes/mode.h"
#include "render/adaptive/to_target.h"

#include <algorithm>
#include <cassert>

namespace tyndall {
namespace {
constexpr int contest_drawings = 2; // of tiles that all are held against the truth on

// A mode with candidates yet to measure.
struct Runner {
    const Mode* mode;
    std::vector<Candidate> candidates;
    size_t next = 0;
    double integrator = infinity; // squared, of the last one measured
    int idle = 0;                 // candidates since one was better than that before it

    void note(double error) { idle = error > 0.9 * integrator ? idle + 1 : 0, integrator = error; }
};

// To get to a goal's error; infinite where too many would be needed.
double samples_for(const Contender& contender, double error) {
    const Choice& choice = contender.choice;
    const double left = error * error - contender.integrator().bound;
    if (!(left > 0)) return infinity;
    const double pixels = static_cast<double>(choice.scout->layers.size.x) * choice.scout->layers.size.y;
    const Allotment spread = choice.spread({left, 1.01 * max_target_samples * pixels}, scout_samples);
    return spread.rays <= max_target_samples * pixels ? spread.rays / pixels : infinity;
}

// The picture a candidate would make of the goal. Where it does not get there, as good as it may become.
void predict(Contender& contender, const Goal& goal) {
    const Measured& m = contender.choice.measured;
    const auto seconds_of = [&](double samples) { return m.prepare_seconds + samples * m.sample_seconds; };
    if (goal.error > 0) {
        contender.samples = samples_for(contender, goal.error);
        const double samples = std::min(contender.samples, 1.0 * max_target_samples);
        contender.seconds = seconds_of(samples), contender.error = std::sqrt(contender.choice.expected(samples));
        if (goal.seconds == 0 || (contender.gets_there() && contender.seconds <= goal.seconds)) return;
    }
    const double samples = std::max(1.0, std::floor((goal.seconds - m.prepare_seconds) / m.sample_seconds));
    contender.seconds = seconds_of(samples), contender.error = std::sqrt(contender.choice.expected(samples));
    contender.samples = goal.error > 0 || contender.seconds > goal.seconds ? infinity : samples;
}

// Whether finer candidates of a mode than this can still win.
bool may_improve(const Contender& last, int idle, const Contender& best, const Goal& goal) {
    constexpr int max_idle = 2; // reduced pictures may be as wrong as each other beside a lamp
    const Measured& m = last.choice.measured;
    const double least = m.prepare_seconds + m.sample_seconds;
    if (!last.choice.has_integrator) return false;
    if (idle >= max_idle) return false;
    if (goal.error > 0 && best.gets_there() && least >= best.seconds) return false;
    if (goal.error > 0 && last.gets_there() && m.integrator.value < 0.25 * goal.error * goal.error) return false;
    // Where noise rules, or time is nearly up, finer is worse.
    return !(goal.seconds > 0 && (least > 0.5 * goal.seconds || last.error * last.error > 4 * m.integrator.value));
}

std::vector<Runner> runners_of(std::span<const Mode> modes, const Settings& settings, Quality quality) {
    std::vector<Runner> runners;
    for (const Mode& mode : modes)
        if (error_can_be_told(mode) && (settings.fluence.orders < 2 || mode.adds_fluence))
            runners.push_back({&mode, candidates_of(mode, settings, quality)});
    return runners;
}
}

bool beats(const Contender& a, const Contender& b, const Goal& goal) {
    if (a.gets_there() != b.gets_there()) return a.gets_there();
    return a.gets_there() && goal.error > 0 ? a.seconds < b.seconds : a.error < b.error;
}

Contest hold_contest(std::span<const Mode> modes, const View& view, const Snapshot& snapshot, const Settings& settings,
                     const Settings& wanted, const Goal& goal, const FrameOptions& options) {
    assert(goal.error > 0 || goal.seconds > 0);
    const double start = goal.clock();
    const Settings truth = truth_of(wanted);
    const std::shared_ptr<const Scout> scout = make_scout(
        main_mode(), view, snapshot, candidates_of(main_mode(), settings, goal.quality)[0], options, goal.clock);
    Pilot pilot = make_pilot(main_mode(), view, snapshot, &truth, chances_in(scout->layers), 0, options);
    while (pilot.drawings < contest_drawings && !pilot.is_full()) grow(pilot);
    Look look{main_mode(), scout->candidate.settings, scout->prepared};
    Measured scouted = measure(pilot, look, goal.clock);
    const double pace = scout->seconds / scout_samples / std::max(scouted.sample_seconds, 1e-9);
    scouted.prepare_seconds = scout->prepare_seconds;
    const double power = spread_power(pilot, main_mode(), scout->candidate.settings, *scout->prepared);

    Contest contest;
    std::vector<Runner> runners = runners_of(modes, settings, goal.quality);
    size_t all = 0;
    for (const Runner& runner : runners) all += runner.candidates.size();
    while (!runners.empty()) {
        for (Runner& runner : runners) {
            const Candidate& candidate = runner.candidates[runner.next++];
            Contender contender{runner.mode, {candidate, {}, has_integrator(*runner.mode)}};
            Choice& choice = contender.choice;
            const bool is_scout = runner.mode->name == main_mode().name && candidate.name == scout->candidate.name;
            choice.measured = is_scout ? scouted : measure(pilot, *runner.mode, candidate.settings, goal.clock);
            Measured& measured = choice.measured;
            choice.power = choice.has_integrator ? power : 1;
            measured.sample_seconds *= pace;
            choice.scout = scout, choice.truth_seconds = pilot.truth_seconds(), choice.truth = pilot.prepared;
            if (scouted.sample.value > 0)
                choice.noise_ratio = std::max(measured.sample.value / scouted.sample.value, 1e-6);
            predict(contender, goal);
            measured.prepared = nullptr; // it may be large
            contest.contenders.push_back(std::move(contender));
            const size_t here = contest.contenders.size() - 1;
            if (here == 0 || beats(contest.contenders[here], contest.best(), goal)) contest.winner = here;
            const Contender& last = contest.contenders.back();
            runner.note(last.choice.measured.integrator.value);
            if (!may_improve(last, runner.idle, contest.best(), goal)) runner.next = runner.candidates.size();
        }
        size_t left = 0;
        for (const Runner& runner : runners) left += runner.candidates.size() - runner.next;
        if (options.progress) options.progress(1 - static_cast<double>(left) / static_cast<double>(all));
        std::erase_if(runners, [](const Runner& runner) { return runner.next >= runner.candidates.size(); });
    }
    assert(!contest.contenders.empty());
    contest.seconds = goal.clock() - start;
    return contest;
}
}
