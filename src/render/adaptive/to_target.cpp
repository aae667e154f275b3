#include "render/adaptive/to_target.h"

#include "base/error.h"
#include "render/adaptive/check.h"
#include "render/adaptive/errors/orders.h"
#include "render/adaptive/errors/shutter_error.h"
#include "render/adaptive/target_rounds.h"
#include "render/frame/layers.h"
#include "trace/transmittance/light_depth.h"

#include <algorithm>
#include <cassert>
#include <limits>

namespace tyndall {
namespace {
constexpr double max_check_share = 0.2; // of the time limit
constexpr double longest_seconds = 600; // limit if none is given and the error is far off
constexpr double soon = 2;              // seconds: a forecast waits for a round as short as this
constexpr int max_rounds = std::numeric_limits<int>::max();

TargetRounds rounds_of(const Mode& mode, const View& view, Goal& goal) {
    TargetRounds rounds{mode, view, goal, goal.clock(), goal.seconds > 0, {}};
    rounds.view.lamp_samples = rounds.view.edge_samples = 1;
    return rounds;
}

Choice choice_for(const TargetRounds& rounds, const Snapshot& snapshot, const Settings& settings,
                  const FrameOptions& options) {
    const Goal& goal = rounds.goal;
    if (goal.choice) return *goal.choice;
    Choice choice = choose(rounds.mode, rounds.view, snapshot, settings, goal, rounds.start, options);
    if (goal.error == 0 || !is_out_of_reach(choice, goal.error) || !goal.wanted) return choice;
    return choose(rounds.mode, rounds.view, snapshot, *goal.wanted, goal, rounds.start, options);
}
}

int batched_samples(int samples) { return (samples + noise_batches - 1) / noise_batches * noise_batches; }

void check_target(const Mode& mode, std::string_view option) {
    if (has_error_bound(mode)) return;
    fail(ExitCode::usage, std::string(option),
         "mode '" + std::string(mode.name) + "' is artistic: it has no error bound; --mode auto picks a mode with one");
}

namespace {
// What all rounds of an image are rendered with.
struct Rendering {
    const Mode& mode;
    const Snapshot& snapshot;
    const FrameOptions& options;
    const Settings& requested;
    Settings settings;                        // of the candidate
    std::shared_ptr<const Prepared> prepared; // null = each round prepares itself
};

// Error of motion blur from the shutter's moments, if any; reduces goal.error to what that leaves, and sets the number
// of moments `wanted` instead, 0 = these.
std::optional<Noise> measure_moments(TargetRounds& rounds, Rendering& rendering, int& wanted) {
    const auto& [mode, snapshot, options, requested, settings, prepared] = rendering;
    if (!has_moments(rounds.view, snapshot)) return {};
    if (!prepared)
        rendering.prepared =
            std::make_shared<const Prepared>(prepare_frame(mode, rounds.view, snapshot, settings, options.history));
    const std::shared_ptr<const Scout> scout = rounds.choice ? rounds.choice->scout : nullptr;
    Goal& goal = rounds.goal;
    const SquaredError error = moments_error(mode, rounds.view, snapshot, settings, *rendering.prepared,
                                             scout ? chances_in(scout->layers) : uniform_chances(rounds.view, snapshot),
                                             goal.error, goal.seconds > 0, options);
    const Noise moments{std::sqrt(error.value), std::sqrt(error.bound)};
    wanted = moments_for(moments, static_cast<int>(rounds.view.shutter->cameras.size()), goal);
    if (goal.error > 0) goal.error = remaining_error(moments, goal.error).value_or(goal.error); // none = goal missed
    return moments;
}

void note_integrator(const Choice& choice, FrameStats& stats) {
    if (!choice.has_integrator) return;
    const SquaredError& error = choice.measured.integrator;
    stats.integrator = {
        {std::sqrt(error.value), std::sqrt(error.bound)}, choice.candidate.name, choice.candidate.settings};
}

// Starts over with the choice's candidate, prepared once for all rounds.
void begin(const Choice& choice, TargetRounds& rounds, Rendering& rendering, FrameStats& stats) {
    rounds.choice = choice, rounds.allotment.reset(), rounds.first_part = 1;
    rounds.done = 0, rounds.freedom = 0, rounds.expected = max_target_samples;
    rounds.work_seconds = choice.measured.sample_seconds;
    rounds.check_seconds = check_seconds(choice);
    if (rounds.goal.seconds > 0 && rounds.check_seconds > max_check_share * rounds.goal.seconds)
        rounds.check_seconds = 0; // there is no time for one
    rendering.settings = choice.candidate.settings, rendering.prepared = choice.measured.prepared;
    if (!rendering.prepared && choice.scout && choice.scout->candidate.name == choice.candidate.name)
        rendering.prepared = choice.scout->prepared;
    if (!rendering.prepared)
        rendering.prepared = std::make_shared<const Prepared>(prepare_frame(
            rendering.mode, rounds.view, rendering.snapshot, rendering.settings, rendering.options.history));
    stats.fog_seconds += rendering.prepared->mode_seconds;
    note_integrator(choice, stats);
}

// Reports the predicted total seconds if `more` remain: at first, and again if that turns out wrong early on. Stats
// keep the last forecast of the first third, or later the first that is not infinite. A goal that is far off gets a
// time limit.
void make_forecast(double more, TargetRounds& rounds, const FrameOptions& options, FrameStats& stats) {
    constexpr double wrong = 1.5;
    const double passed = rounds.goal.clock() - rounds.start, seconds = passed + more, before = stats.forecast_seconds;
    if (before > 0 && before < infinity && passed > early_share_of_time * seconds) return;
    stats.forecast_seconds = seconds;
    if (rounds.goal.seconds == 0 && seconds > longest_seconds) rounds.goal.seconds = longest_seconds;
    const bool as_before = before > 0 && (seconds == before || (seconds < wrong * before && before < wrong * seconds));
    if (options.forecast && !as_before) options.forecast(seconds);
}

// Whether the first forecast waits for a round of `work`, which is short and shows how fast noise falls.
bool waits_for(double work, const TargetRounds& rounds, const FrameStats& stats) {
    return work * rounds.work_seconds < soon && stats.forecast_seconds == 0;
}

// The image that the rounds so far add up to.
struct ImageSoFar {
    Layers layers;
    FrameStats& stats;
    int rounds = 0; // across restarts: each has random numbers of its own
};

// Renders rounds until the noise meets the goal or time is up, at most `most` of them; returns the work of the next
// one, 0 if none is to follow.
double render_rounds(TargetRounds& rounds, const Rendering& rendering, double work, int most, ImageSoFar& image) {
    FrameStats& stats = image.stats;
    const double pixels = pixel_count(rounds.view);
    const auto& progress = rendering.options.progress;
    double begun = std::min(1.0, rounds.done / rounds.expected), rays = stats.samples * pixels; // of rounds that count
    if (rounds.done == 0) rays = 0;
    for (int rendered = 0; work > 0 && rendered < most; ++rendered) {
        std::optional<AllottedPart> part;
        if (rounds.done == 0) rounds.sequence = image.rounds;
        if (rounds.allotment)
            part = allotted_part(*rounds.allotment, rounds.done, rounds.done + work, rounds.unit(), rounds.continues());
        const View view = rounds.round_view(work, image.rounds, part ? &*part : nullptr);
        const double reached = std::max(begun, std::min(1.0, (rounds.done + work) / rounds.expected));
        FrameOptions options = rendering.options;
        options.prepared = rendering.prepared;
        if (progress) options.progress = [&](double share) { progress(begun + share * (reached - begun)); };

        FrameStats round_stats;
        const double start = rounds.goal.clock();
        Layers layers =
            render_frame(rendering.mode, view, rendering.snapshot, rendering.settings, options, round_stats);
        rounds.work_seconds = (rounds.goal.clock() - start) / work;
        rounds.freedom += view.batches - 1, begun = reached, ++image.rounds;
        if (rounds.done == 0)
            image.layers = std::move(layers);
        else if (part)
            blend_layers(image.layers, layers, part->shares);
        else
            blend_layers(image.layers, layers, static_cast<float>(work / (rounds.done + work)));
        rounds.done += work, rays += static_cast<double>(round_stats.camera_rays);
        stats.add(round_stats);
        stats.samples = static_cast<int>(std::lround(rays / pixels));

        const bool meets = judge(rounds, image.layers, stats);
        if (meets || rays >= max_target_samples * pixels) return 0;
        // An image of one sample per pixel has no variance to continue from: start over if it took less time than
        // expected, else stop.
        if (rounds.freedom == 0) {
            if (!(rounds.goal.seconds > 0 && rounds.left() > 2.5 * rounds.work_seconds)) return 0;
            rounds.done = rays = 0, work = first_round(rounds);
            continue;
        }
        if (begin_allotment(rounds, image.layers, stats)) rays = 0;
        work = next_round(rounds, stats);
        if (work == 0 || rounds.goal.error == 0 || (rounds.done == 0 && waits_for(work, rounds, stats))) continue;
        const double more = (rounds.expected - rounds.done) * rounds.work_seconds;
        make_forecast(more + rounds.check_seconds, rounds, rendering.options, stats);
        work = next_round(rounds, stats); // within the limit that the forecast may have set
    }
    return work;
}

// Renders until the image is done or its integrator is to be checked, beginning with the scout if there is one; returns
// whether it is done.
bool render_until_check(TargetRounds& rounds, const Rendering& rendering, ImageSoFar& image) {
    const bool scouted = rounds.choice && rounds.choice->scout;
    const double work = scouted ? begin_with_scout(rounds, image.stats) : first_round(rounds);
    if (rounds.goal.error > 0 && has_integrator(rendering.mode)) {
        const double ahead = seconds_ahead(rounds, work);
        const bool wait = ahead < infinity && waits_for(work, rounds, image.stats);
        if (!wait) make_forecast(ahead, rounds, rendering.options, image.stats);
    }
    return render_rounds(rounds, rendering, work, rounds.checks_early() ? 1 : max_rounds, image) == 0;
}

// What is checked: the finished image, or one that its first rounds show, with the noise it is meant to reach.
CheckedImage checked_image(const TargetRounds& rounds, const ImageSoFar& image, bool is_done, bool may_restart) {
    const double taken = image.stats.samples;
    if (is_done) return {image.layers, *image.stats.noise, taken, taken, may_restart};
    const double bound = rounds.noise_target();
    const double unit = rounds.allotment ? rounds.allotment->rays / pixel_count(rounds.view) : 1;
    return {image.layers, {bound, bound, bound}, unit * rounds.expected, unit * rounds.done, may_restart};
}

// Checks the integrator. Starts over with another candidate and returns true if the check asks for one; otherwise
// renders what the image still lacks.
bool check_starts_over(TargetRounds& rounds, Rendering& rendering, bool is_done, uint32_t check, ImageSoFar& image) {
    const Goal& goal = rounds.goal;
    const Mode& mode = rendering.mode;
    const double until = rounds.start + goal.seconds - 0.5 * rounds.check_seconds;
    Goal asked = goal;
    if (!rounds.is_timed) asked.seconds = 0; // no limit from the forecast: a finer candidate may take less time
    const CheckedImage checked = checked_image(rounds, image, is_done, check < max_checks);
    const Choice after = check_choice(*rounds.choice, checked, until, mode, rounds.view, rendering.snapshot,
                                      rendering.requested, asked, check, rendering.options);
    if (after.candidate.name != rounds.choice->candidate.name) {
        begin(after, rounds, rendering, image.stats);
        return true;
    }
    rounds.choice = after;
    note_integrator(after, image.stats);

    const double times = after.times_to(goal.error, after.measured.integrator.bound, checked.noise);
    const double left = (times * checked.samples - checked.done) * after.measured.sample_work;
    const double seconds_left = left * after.measured.sample_seconds / after.measured.sample_work;
    const bool worth = !after.from_contest || rounds.is_timed || seconds_left < goal.other_seconds;
    const bool lacks = !is_done || (rounds.freedom > 0 && !judge(rounds, image.layers, image.stats));
    if (goal.error > 0 && worth && lacks)
        render_rounds(rounds, rendering, next_round(rounds, image.stats), max_rounds, image);
    return false;
}
}

Layers render_to_target(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                        Goal goal, const FrameOptions& options, FrameStats& stats) {
    assert(has_error_bound(mode) && (goal.error > 0 || goal.seconds > 0));
    if (!goal.clock) goal.clock = steady_seconds;
    const double start = goal.clock();
    const std::optional<OrdersError> orders = measure_orders(mode, view, snapshot, settings, goal, options);
    TargetRounds rounds = rounds_of(mode, view, goal);
    rounds.start = start;
    Rendering rendering{mode, snapshot, options, settings, settings, nullptr};
    stats = {};
    ImageSoFar image{{}, stats};
    if (has_integrator(mode) || goal.seconds > 0) {
        begin(choice_for(rounds, snapshot, settings, options), rounds, rendering, stats);
        stats.prepare_seconds = goal.clock() - rounds.start;
        image.rounds = 1; // no round may reuse a scout's random numbers
    }
    const std::optional<Noise> moments = measure_moments(rounds, rendering, stats.wanted_moments);
    if (stats.wanted_moments > 0) {
        stats.goal_seconds = goal.clock() - rounds.start;
        return {};
    }
    for (uint32_t check = 1; check <= max_checks; ++check) {
        const bool is_done = render_until_check(rounds, rendering, image);
        const bool has_time = goal.seconds == 0 || rounds.check_seconds > 0;
        if (!has_integrator(mode) || !has_time) break;
        if (!check_starts_over(rounds, rendering, is_done, check, image)) break;
    }
    stats.orders = orders, stats.moments_error = moments;
    stats.goal_seconds = goal.clock() - rounds.start;
    if (options.progress) options.progress(1);
    return std::move(image.layers);
}
}
