#include "render/adaptive/contest.h"

#include "modes/mode.h"
#include "render/adaptive/to_target.h"
#include "trace/snapshot.h"

#include <algorithm>
#include <cassert>

namespace tyndall {
namespace {
// Measured on random scenes: the median time to measure the modes of a brief contest, relative to the main one's, and
// how often a mode whose integrator leaves little room for noise misses the target error.
constexpr double others_share = 0.05, chance_to_miss = 0.5;

// Predicted times relative to the best so far up to which a scout is worth its cost: any, and one that is cheap.
constexpr double max_hoped = 0.75, max_hoped_if_cheap = 2;

// A contest that may take less than this share of an image's time is brief: it is for one image or a few.
constexpr double brief_share = 0.25;

// Times what measuring the main mode took: the longest image that is relied on when time is granted to the others.
// Where few pixels hold most of the noise, a forecast from two samples may be thousands of times too long.
constexpr double longest_relied_on = 20;

// Consecutive candidates without a clear improvement after which a mode's finer ones are not measured: at reduced
// resolution, two may be about as wrong near a lamp.
constexpr int max_idle = 2;

// A mode with candidates yet to measure.
struct Runner {
    const Mode* mode;
    std::vector<Candidate> candidates;
    size_t next = 0;
    double seconds = 0;           // taken to measure the last candidate
    double integrator = infinity; // bound of the last candidate's squared integrator error
    int idle = 0;                 // consecutive candidates without a clear improvement

    void note(double error) {
        const double ratio = std::sqrt(error / integrator);
        const bool equal = ratio > 0.98 && ratio < 1.02; // finer ones differ in nothing that matters here
        idle = equal ? max_idle : ratio > 0.95 ? idle + 1 : 0;
        integrator = error;
    }
    // Estimated probability that a finer candidate reaches an error: each halves it at best.
    double chance(double error) const {
        const double left = static_cast<double>(candidates.size() - next);
        return error > 0 ? std::clamp(std::exp2(left) * error / std::sqrt(integrator) - 1, 0.0, 1.0) : 1;
    }
};

// Ratio of the bound of an image's squared noise to its expected value: large if few pixels cause the noise.
double squared_chance(const Layers& layers) {
    const Noise noise = noise_of(layers);
    return noise.error > 0 && noise.error < infinity ? std::pow(noise.settled / noise.error, 2) : 1;
}

// Samples per pixel that bring the error bound down to `error`; infinite if that takes more than max_target_samples.
double samples_for(const Contender& contender, double error) {
    const Choice& choice = contender.choice;
    const double chance = choice.scout ? squared_chance(choice.scout->layers) : 1;
    const double left = (error * error - contender.integrator().bound) / chance;
    if (!(left > 0) || (choice.has_integrator && !choice.scout)) return infinity;
    // Without a scout, or if it is free of noise, assume the same noise in all pixels.
    if (!choice.scout || choice.scout_variance == 0) {
        const double samples = std::ceil(choice.measured.sample.value / left);
        return samples <= max_target_samples ? std::max(samples, 1.0 * scout_samples) : infinity;
    }
    const double pixels = static_cast<double>(choice.scout->layers.size.x) * choice.scout->layers.size.y;
    const Allotment spread = choice.spread({left, 1.01 * max_target_samples * pixels}, scout_samples);
    const bool reaches = spread.squared_error <= 1.001 * left && spread.rays <= max_target_samples * pixels;
    return reaches ? spread.rays / pixels : infinity;
}

// Predicts the image that a candidate renders for the goal; if it misses the goal, the best it can do.
void predict(Contender& contender, const Goal& goal) {
    const Measurement& m = contender.choice.measured;
    const auto seconds_of = [&](double samples) { return m.prepare_seconds + samples * m.sample_seconds; };
    if (goal.error > 0) {
        contender.samples = samples_for(contender, goal.error);
        const double samples = std::min(contender.samples, 1.0 * max_target_samples);
        contender.seconds = seconds_of(samples), contender.error = std::sqrt(contender.choice.expected(samples));
        if (goal.seconds == 0 || (contender.reaches_goal() && contender.seconds <= goal.seconds)) return;
    }
    const double samples = std::max(1.0, std::floor((goal.seconds - m.prepare_seconds) / m.sample_seconds));
    contender.seconds = seconds_of(samples), contender.error = std::sqrt(contender.choice.expected(samples));
    contender.samples = goal.error > 0 || contender.seconds > goal.seconds ? infinity : samples;
}

// Whether a mode's finer candidates can still win.
bool may_improve(const Contender& last, int idle, const Contender& best, const Goal& goal) {
    const Measurement& m = last.choice.measured;
    const double least = m.prepare_seconds + m.sample_seconds;
    if (!last.choice.has_integrator) return false;
    if (idle >= max_idle) return false;
    if (goal.error > 0 && best.reaches_goal() && least >= best.seconds_ahead()) return false;
    if (goal.error > 0 && last.reaches_goal() && m.integrator.value < 0.25 * goal.error * goal.error) return false;
    // If noise dominates or time is nearly up, a finer candidate is worse.
    return !(goal.seconds > 0 && (least > 0.5 * goal.seconds || last.error * last.error > 4 * m.integrator.value));
}

// Whether a mode's next candidate is worth measuring, of `allowed` seconds with `left` to go. A finer candidate takes
// longer than the one before. A mode's first candidate may use up to twice the time, so that one slow mode does not
// keep the others from being measured.
bool is_worthwhile(const Runner& runner, double left, double allowed, const Contender& best, const Goal& goal) {
    if (runner.next == 0) return left + allowed > 0;
    const double chance = best.reaches_goal() ? runner.chance(goal.error) : 1;
    return left == infinity || std::min(left, 0.5 * allowed) * chance > 3 * runner.seconds;
}

// All modes but the main one; in a `brief` contest only those that often win. Modes whose only error is noise take part
// only if `noisy`: they are never the fastest.
std::vector<Runner> runners_of(std::span<const Mode> modes, const Settings& settings, Quality quality, bool brief,
                               bool noisy) {
    std::vector<Runner> runners;
    for (const Mode& mode : modes)
        if (has_error_bound(mode) && mode.name != main_mode().name && (!brief || mode.often_fastest) &&
            (noisy || !is_unbiased(mode)) && (settings.fluence.orders < 2 || mode.adds_fluence))
            runners.push_back({&mode, candidates_of(mode, settings, quality)});
    return runners;
}

// Only the winner keeps its prepared data, which may be large.
void add(Contender contender, const Goal& goal, Contest& contest) {
    const bool wins = contest.contenders.empty() || beats(contender, contest.best(), goal);
    if (!wins) contender.choice.measured.prepared = nullptr;
    if (wins && !contest.contenders.empty()) contest.contenders[contest.winner].choice.measured.prepared = nullptr;
    contest.contenders.push_back(std::move(contender));
    if (wins) contest.winner = contest.contenders.size() - 1;
}

// Measures another mode's candidate on the main mode's pilot; the main mode's image takes `main_seconds`.
Contender measure_rival(const Choice& main, double main_seconds, const Mode& mode, const Candidate& candidate,
                        const Goal& goal) {
    Contender contender{&mode,
                        {candidate, measure(*main.pilot, mode, candidate.settings, goal.clock), has_integrator(mode)}};
    Choice& choice = contender.choice;
    choice.power = choice.has_integrator ? main.power : 1;
    choice.pace = main.pace, choice.measured.sample_seconds *= main.pace;
    choice.scout = main.scout, choice.from_contest = true, choice.pilot = main.pilot,
    choice.scout_variance = main.scout_variance;
    if (main.scout_variance > 0)
        choice.noise_ratio = std::max(choice.measured.sample.value / main.scout_variance, 1e-6);
    predict(contender, goal);
    if (goal.error > 0 && !leaves_room(choice, goal.error)) contender.risk = chance_to_miss * main_seconds;
    return contender;
}

// If the contender may win, renders a scout with it: compared with the main mode's, it predicts noise and time better
// than the pilot's tiles do.
void send_scout(Contender& contender, double best_seconds, double left, const View& view, const Snapshot& snapshot,
                const Goal& goal, const FrameOptions& options) {
    Choice& choice = contender.choice;
    Contender hoped = contender; // as noisy as the main mode, and as quick as in the pilot
    hoped.choice.noise_ratio = std::min(choice.noise_ratio, 1.0);
    hoped.choice.measured.sample_seconds /= std::max(choice.pace, 1.0);
    predict(hoped, goal);
    const bool cheap = scout_samples * hoped.choice.measured.sample_seconds < left;
    const double ahead = hoped.seconds - hoped.done;
    if (!hoped.reaches_goal() || ahead > (cheap ? max_hoped_if_cheap : max_hoped) * best_seconds) return;
    const std::shared_ptr<const Scout> own =
        make_scout(*contender.mode, view, snapshot, choice.candidate, options, goal.clock, choice.measured.prepared);
    const double noise = noise_of(own->layers).error, main_noise = noise_of(choice.scout->layers).error;
    if (noise > 0 && main_noise > 0) choice.noise_ratio = std::pow(noise / main_noise, 2);
    choice.measured.sample_seconds = own->sample_seconds;
    predict(contender, goal);
}
}

Contender sole_contender(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                         const Goal& goal, const FrameOptions& options) {
    Contender alone{&mode, choose(mode, view, snapshot, settings, goal, goal.clock(), options)};
    predict(alone, goal);
    return alone;
}

bool beats(const Contender& a, const Contender& b, const Goal& goal) {
    if (a.reaches_goal() != b.reaches_goal()) return a.reaches_goal();
    return a.reaches_goal() && goal.error > 0 ? a.seconds_ahead() < b.seconds_ahead() : a.error < b.error;
}

Contest hold_contest(std::span<const Mode> modes, const View& view, const Snapshot& snapshot, const Settings& settings,
                     const Goal& goal, double share, const FrameOptions& options) {
    assert(goal.error > 0 || goal.seconds > 0);
    const double start = goal.clock();
    Contest contest;
    Contender main = sole_contender(main_mode(), view, snapshot, settings, goal, options);
    Choice first = main.choice;
    first.measured.prepared = nullptr;
    const bool brief = share < brief_share && main.reaches_goal() && modes.size() > 1;
    if (brief && main.choice.scout && main.choice.scout->candidate.name == main.choice.candidate.name)
        main.done = main.choice.scout->prepare_seconds;
    const double main_seconds = main.seconds_ahead(), begun = goal.clock();
    const double known = std::min(main_seconds, longest_relied_on * (begun - start));
    const double allowed = share * (goal.seconds > 0 ? goal.seconds : known);
    const bool too_costly = goal.seconds == 0 && main.reaches_goal() && allowed < others_share * (begun - start);
    const bool same_light = max_component(snapshot.ambient) == 0; // path tracing shadows it, the ground truth does not
    const bool noisy = same_light && (share == infinity || !main.reaches_goal() || modes.size() == 1);
    if (std::ranges::count(modes, main.mode->name, &Mode::name)) add(std::move(main), goal, contest);

    std::vector<Runner> runners;
    if (first.scout && (!too_costly || contest.contenders.empty()))
        runners = runners_of(modes, settings, goal.quality, brief, noisy);
    const size_t all = std::max<size_t>(runners.size(), 1);
    while (!runners.empty()) {
        for (Runner& runner : runners) {
            const double before = goal.clock(), left = allowed - (before - begun);
            const bool is_first = contest.contenders.empty(); // it is always measured
            if (!is_first && !is_worthwhile(runner, left, allowed, contest.best(), goal)) {
                runner.next = runner.candidates.size();
                continue;
            }
            Contender rival = measure_rival(first, main_seconds, *runner.mode, runner.candidates[runner.next++], goal);
            runner.seconds = goal.clock() - before;
            if (brief) rival.done = rival.choice.measured.prepare_seconds;
            if (goal.error > 0 && goal.seconds == 0 && rival.choice.has_integrator)
                send_scout(rival, is_first ? infinity : contest.best().seconds_ahead() - rival.risk, left, view,
                           snapshot, goal, options);
            add(std::move(rival), goal, contest);
            const Contender& last = contest.contenders.back();
            runner.note(last.choice.measured.integrator.bound);
            if (!may_improve(last, runner.idle, contest.best(), goal)) runner.next = runner.candidates.size();
        }
        std::erase_if(runners, [](const Runner& runner) { return runner.next >= runner.candidates.size(); });
        if (options.progress) options.progress(1 - static_cast<double>(runners.size()) / static_cast<double>(all));
    }
    if (contest.contenders.empty()) add({&main_mode(), std::move(first)}, goal, contest);
    contest.seconds = goal.clock() - start;
    return contest;
}
}
