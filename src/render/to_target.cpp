#include "render/to_target.h"

#include "base/error.h"
#include "base/random.h"
#include "render/layers_mean.h"
#include "render/noise.h"

#include <algorithm>
#include <cassert>

namespace tyndall {
namespace {
// All the samples a pixel will have taken, going by the noise after `samples`: variance falls with their number. A
// fiftieth more, so that the bound is met at the first try more often than not.
int samples_needed(const Noise& noise, int samples, double target, int batches) {
    const double ratio = noise.bound / target, needed = 1.02 * samples * ratio * ratio;
    if (!(needed < most_target_samples)) return most_target_samples;
    const int whole = (static_cast<int>(std::ceil(needed)) + batches - 1) / batches * batches;
    return std::max(whole, samples + batches);
}

// The rounds of one picture.
struct Rounds {
    const Mode& mode;
    const View& view; // as asked for
    const Goal& goal;
    double start = 0;             // of the goal's time
    std::optional<Choice> choice; // where anything was measured beforehand
    double sample_seconds = 0;    // by the last round, or by what was measured
    int freedom = 0;              // differences between batches so far
    int expected = most_target_samples;

    double left() const { return goal.seconds - (goal.clock() - start); }
    int most_batches() const { return error_is_noise(mode) || view.batches > 1 ? noise_batches : 2; }
    int fewest() const { return view.batches > 1 ? 2 : 1; }

    // What the integrator leaves of the error; where it leaves nothing, noise need not be smaller than it.
    double noise_target() const {
        const double bound = choice && choice->has_integrator ? choice->measured.integrator.bound : 0;
        if (bound == 0) return goal.error;
        const double share = std::sqrt(std::max(1 - bound / (goal.error * goal.error), 0.0));
        return goal.error * (bound < goal.error * goal.error ? share : integrator_share);
    }
};

// Where nothing is known, the first round is as the view asks; otherwise less than what is likely to be needed, since a
// round too many costs less than one too large. More rays at edges leave less to do for others.
int first_round(Rounds& rounds) {
    if (!rounds.choice) return std::min(batched_samples(rounds.view.pixel_samples), most_target_samples);
    const Measured& measured = rounds.choice->measured;
    int samples = most_target_samples;
    if (rounds.goal.error > 0) {
        const double ratio = measured.sample.value / std::pow(rounds.noise_target(), 2);
        const double needed = std::pow(ratio, 1 / rounds.choice->power);
        const double part = rounds.view.edge_samples > 1 ? 6 : 3;
        samples = static_cast<int>(std::clamp(std::ceil(needed / part), 2.0, most_target_samples / 2.0));
        if (measured.single.bound <= rounds.goal.error * rounds.goal.error) samples = 1;
        rounds.expected = std::max(samples, static_cast<int>(std::min<double>(needed, most_target_samples)));
    }
    if (rounds.goal.seconds > 0) {
        const double time = std::floor(std::min(rounds.left() / rounds.sample_seconds, 0.0 + most_target_samples));
        samples = std::min(samples, static_cast<int>(std::max(time > 4 ? time / 2 : time, 1.0)));
        rounds.expected = std::min(rounds.expected, static_cast<int>(std::max(time, 1.0)));
    }
    return std::max(samples, rounds.fewest());
}

// Rounds stay large enough for a few to do, and no round wastes more than all before it; 0 when time is up.
int next_round(Rounds& rounds, const FrameStats& stats) {
    const int samples = stats.samples, batches = std::min(rounds.most_batches(), samples);
    int wanted = most_target_samples - samples;
    if (rounds.goal.error > 0) {
        rounds.expected = samples_needed(*stats.noise, samples, rounds.noise_target(), batches);
        const int least = (samples / 8 + batches - 1) / batches * batches;
        wanted = std::min(std::clamp(rounds.expected - samples, least, samples), wanted);
    }
    if (rounds.goal.seconds > 0) {
        const double time = std::floor(std::min<double>(rounds.left() / rounds.sample_seconds, wanted));
        if (time < std::max({2, batches / 8, samples / 16})) return 0;
        wanted = static_cast<int>(time);
        if (rounds.goal.error == 0) rounds.expected = samples + wanted;
    }
    return wanted;
}

// Of a picture of one sample per pixel, going by what was measured beforehand.
Noise single_noise(const Choice& choice) {
    const Measured& m = choice.measured;
    const SquaredError integrator = choice.has_integrator ? m.integrator : SquaredError{};
    return {std::sqrt(std::max(m.single.value - integrator.value, 0.0)),
            std::sqrt(std::max(m.single.bound - integrator.bound, 0.0))};
}

// Sets what is known of the error after each round; true when it is small enough, or as small as the integrator lets it
// become.
bool judge(Rounds& rounds, const Layers& result, FrameStats& stats) {
    if (rounds.freedom > 0)
        stats.noise = noise_of(result, rounds.freedom);
    else
        stats.noise = single_noise(*rounds.choice);
    const double target = rounds.goal.error;
    const bool hopeless = stats.integrator && stats.integrator->error.bound >= target;
    return target > 0 && (hopeless ? stats.noise->bound <= rounds.noise_target() : stats.error()->bound <= target);
}
}

int batched_samples(int samples) { return (samples + noise_batches - 1) / noise_batches * noise_batches; }

void check_target(const Mode& mode, std::string_view option) {
    if (error_can_be_told(mode)) return;
    fail(ExitCode::usage, std::string(option),
         "mode '" + std::string(mode.name) +
             "' is a look: its error is as large as it is; --mode auto picks one that fits");
}

Layers render_to_target(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                        Goal goal, const FrameOptions& options, FrameStats& stats) {
    assert(error_can_be_told(mode) && (goal.error > 0 || goal.seconds > 0));
    if (!goal.clock) goal.clock = steady_seconds;
    Rounds rounds{mode, view, goal, goal.clock(), {}, 0};
    FrameOptions round_options = options;
    Settings chosen = settings;
    stats = {};
    if (has_integrator(mode) || goal.seconds > 0) {
        rounds.choice =
            goal.choice ? *goal.choice : choose(mode, view, snapshot, settings, goal, rounds.start, options);
        chosen = rounds.choice->candidate.settings;
        rounds.sample_seconds = rounds.choice->measured.sample_seconds;
        round_options.prepared = rounds.choice->measured.prepared;
        stats.prepare_seconds = goal.clock() - rounds.start;
        if (round_options.prepared) stats.fog_seconds = round_options.prepared->mode_seconds;
        const SquaredError& error = rounds.choice->measured.integrator;
        if (rounds.choice->has_integrator)
            stats.integrator = {
                {std::sqrt(error.value), std::sqrt(error.bound)}, rounds.choice->candidate.name, chosen};
    }

    // Until the first round has shown how noisy the scene is, all samples there may be count as work.
    View round_view = view;
    Layers result;
    double begun = 0;
    int samples = first_round(rounds);
    for (int round = 0; samples > 0; ++round) {
        if (round) round_view.seed = hash(view.seed, static_cast<uint32_t>(round));
        round_view.batches = std::min(rounds.most_batches(), samples);
        round_view.pixel_samples = samples / round_view.batches * round_view.batches;
        const double share = std::min(1.0, 1.0 * (stats.samples + round_view.pixel_samples) / rounds.expected);
        const double reached = std::max(begun, share);
        if (options.progress)
            round_options.progress = [&](double part) { options.progress(begun + part * (reached - begun)); };

        FrameStats round_stats;
        const double round_start = goal.clock();
        Layers layers = render_frame(mode, round_view, snapshot, chosen, round_options, round_stats);
        rounds.sample_seconds = (goal.clock() - round_start) / round_view.pixel_samples;
        stats.add(round_stats), rounds.freedom += round_view.batches - 1, begun = reached;
        if (round == 0)
            result = std::move(layers);
        else
            blend_layers(result, layers, static_cast<float>(round_stats.samples) / static_cast<float>(stats.samples));

        // A picture of one sample is the end: it has no variance to go on from.
        if (judge(rounds, result, stats) || stats.samples >= most_target_samples || rounds.freedom == 0) break;
        samples = next_round(rounds, stats);
    }
    stats.goal_seconds = goal.clock() - rounds.start;
    if (options.progress) options.progress(1);
    return result;
}
}
