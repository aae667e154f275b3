#include "render/adaptive/to_target.h"

#include "base/error.h"
#include "base/random.h"
#include "modes/mode.h"
#include "render/adaptive/allotment.h"
#include "render/adaptive/orders.h"
#include "render/adaptive/shutter_error.h"
#include "render/frame/layers.h"
#include "trace/transmittance/light_depth.h"

#include <algorithm>
#include <cassert>

namespace tyndall {
namespace {
// Of a pixel in a first round: who needs more than sixteen times as many has pixels that spread far more than others,
// which show by then.
constexpr double max_first_samples = 64;
constexpr double max_check_share = 0.2; // of the seconds there are
constexpr double longest_seconds = 600; // where none are given, and an error is far

// All the samples a pixel will have taken, going by the noise after `samples`: variance falls with their number. A
// fiftieth more, so that the bound is met at the first try more often than not.
int samples_needed(const Noise& noise, int samples, double target, int batches) {
    const double ratio = noise.bound / target, needed = 1.02 * samples * ratio * ratio;
    if (!(needed < max_target_samples)) return max_target_samples;
    const int whole = (static_cast<int>(std::ceil(needed)) + batches - 1) / batches * batches;
    return std::max(whole, samples + batches);
}

double pixel_count(const View& view) {
    const ivec2 size = view.crop_low == view.crop_high ? view.size : view.crop_high - view.crop_low;
    return static_cast<double>(size.x) * size.y;
}

// The rounds of one picture. First all pixels take equally many samples; where that shows that some need many more than
// others, it is begun anew with as many as each needs, and once more where that shows what was missed. Work is counted
// in samples of all pixels; then in allotments.
struct Rounds {
    const Mode& mode;
    View view; // as asked for; what spreads most is measured, not guessed from lamps and edges
    Goal& goal;
    double start = 0;             // of the goal's time
    std::optional<Choice> choice; // where anything was measured beforehand
    std::optional<Allotment> allotment{};
    double work_seconds = 0; // of a unit of work: by the last round, or by what was measured
    double first_part = 1;   // of an allotment
    double done = 0, expected = max_target_samples;
    int freedom = 0;          // differences between batches so far
    double check_seconds = 0; // that the check of the picture will take

    double left() const { return goal.seconds - check_seconds - (goal.clock() - start); }
    int max_batches() const { return error_is_noise(mode) || view.batches > 1 ? noise_batches : 2; }
    int fewest() const { return view.batches > 1 ? 2 : 1; }
    // Samples that are allotted at once.
    int unit() const { return view.batches > 1 ? 8 : error_is_noise(mode) ? 4 : 2; }
    double power() const { return choice ? std::clamp(choice->power, 1.0, 1.5) : 1; }

    Image<float> samples_taken(const Layers& layers) const {
        return allotment ? samples_in(*allotment, done, unit()) : samples_alike(layers, done);
    }

    double noise_target() const { return choice ? tyndall::noise_target(*choice, goal.error) : goal.error; }

    // The view of so much work, and the work it is. What is allotted may come in parts.
    View round_view(double& work, int round, const AllottedPart* part) const {
        View result = view;
        if (round > 0) result.seed = hash(view.seed, static_cast<uint32_t>(round));
        result.batches = part ? unit() : std::min(max_batches(), static_cast<int>(work));
        result.pixel_samples = part ? unit() : static_cast<int>(work) / result.batches * result.batches;
        if (part)
            result.allotted = part->factors;
        else
            work = result.pixel_samples;
        return result;
    }
};

Rounds rounds_of(const Mode& mode, const View& view, Goal& goal) {
    Rounds rounds{mode, view, goal, goal.clock(), {}};
    rounds.view.lamp_samples = rounds.view.edge_samples = 1;
    return rounds;
}

// Whether the integrator alone may be as wrong as is allowed.
bool is_out_of_reach(const Choice& choice, double error) {
    return choice.has_integrator && choice.measured.integrator.bound >= error * error;
}

Choice choice_for(const Rounds& rounds, const Snapshot& snapshot, const Settings& settings,
                  const FrameOptions& options) {
    const Goal& goal = rounds.goal;
    if (goal.choice) return *goal.choice;
    Choice choice = choose(rounds.mode, rounds.view, snapshot, settings, goal, rounds.start, options);
    if (goal.error == 0 || !is_out_of_reach(choice, goal.error) || !goal.wanted) return choice;
    return choose(rounds.mode, rounds.view, snapshot, *goal.wanted, goal, rounds.start, options);
}

// Where nothing is known, the first round is as the view asks; otherwise a small part of what is likely to be needed:
// it shows which pixels need it.
int first_round(Rounds& rounds) {
    if (!rounds.choice) return std::min(batched_samples(rounds.view.pixel_samples), max_target_samples);
    const Measured& measured = rounds.choice->measured;
    int samples = max_target_samples;
    if (rounds.goal.error > 0) {
        const double ratio = measured.sample.value / std::pow(rounds.noise_target(), 2);
        const double needed = std::pow(ratio, 1 / rounds.choice->power);
        samples = static_cast<int>(std::clamp(std::ceil(needed / 16), 4.0, max_first_samples));
        if (needed < 8) samples = std::max(static_cast<int>(std::ceil(needed / 2)), 2);
        rounds.expected = std::max<double>(samples, std::min<double>(needed, max_target_samples));
    }
    if (rounds.goal.seconds > 0) {
        // Two samples show where an image spreads, which counts for more than a check of the integrator.
        if (rounds.left() < 2 * rounds.work_seconds) rounds.check_seconds = 0;
        const double time = std::floor(std::min(rounds.left() / rounds.work_seconds, 0.0 + max_target_samples));
        samples = std::min(samples, static_cast<int>(std::max(time > 32 ? time / 8 : time > 4 ? time / 2 : time, 1.0)));
        rounds.expected = std::min(rounds.expected, std::max(time, 1.0));
    }
    return std::max(samples, rounds.fewest());
}

// Work that going on takes until the picture is as good as that of an allotment.
double work_as_it_goes(const Rounds& rounds, const Allotment& allotment, const Noise& noise) {
    // By the bound: where an allotment missed much of what spreads, few batches tell of it.
    if (rounds.allotment && rounds.goal.error > 0)
        return rounds.done * (std::pow(noise.bound / rounds.noise_target(), 2) - 1);
    return rounds.done * (noise.error * noise.error / allotment.squared_error - 1);
}

// Whether samples are better spread by what the rounds so far showed. Then they are, from nothing.
bool begin_allotment(Rounds& rounds, const Layers& layers, FrameStats& stats) {
    const Noise& noise = *stats.noise;
    if (rounds.freedom == 0 || !(noise.error > 0) || !std::isfinite(noise.bound)) return false;
    const double unit_rays = rounds.allotment ? rounds.allotment->rays : pixel_count(rounds.view);
    const double ray_seconds = rounds.work_seconds / unit_rays;
    Enough enough{0, max_target_samples * pixel_count(rounds.view)};
    if (rounds.goal.error > 0)
        enough.squared_error = infinity, enough.squared_bound = std::pow(rounds.noise_target(), 2) / 1.05;
    if (rounds.goal.seconds > 0) enough.rays = std::min(enough.rays, std::max(0.9 * rounds.left() / ray_seconds, 0.0));
    const Image<float> taken = rounds.samples_taken(layers);
    const Allotment allotment = allot(layers, taken, enough, rounds.power(), rounds.unit());

    // As good by going on, without beginning anew: in rounds that know nothing of each other.
    const double as_it_goes = work_as_it_goes(rounds, allotment, noise) * unit_rays;
    const double gain = rounds.allotment ? 2 : 1.2;
    if (!(gain * allotment.rays < as_it_goes) || allotment.rays > 1.1 * enough.rays) return false;
    rounds.work_seconds = ray_seconds * allotment.rays;
    // Noise may fall faster than told from few samples: where many more are to come, some of them show it.
    double growth = 0;
    for (size_t i = 0; i < taken.pixels.size(); ++i)
        growth = std::max(growth, double{allotment.samples.pixels[i]} / taken.pixels[i]);
    rounds.first_part = rounds.allotment || growth > 16 ? 0.4 : 1;
    rounds.allotment = allotment, rounds.done = 0, rounds.freedom = 0, rounds.expected = 1;
    return true;
}

// Parts of an allotment: what noise asks for, and time leaves; 0 when time is up.
double next_part(Rounds& rounds, const FrameStats& stats) {
    double wanted = rounds.goal.error > 0 ? rounds.first_part : 1;
    if (rounds.done > 0 && rounds.goal.error > 0) {
        const double ratio = stats.noise->bound / rounds.noise_target();
        rounds.expected = 1.02 * rounds.done * ratio * ratio;
        wanted = std::clamp(rounds.expected - rounds.done, 0.125 * rounds.done, rounds.done);
    }
    if (rounds.goal.seconds > 0) {
        // Tiles that take most samples may cost more than others: the first part shows it.
        const double safe = rounds.done > 0 ? 0.9 : 0.5;
        wanted = std::min(wanted, safe * rounds.left() / rounds.work_seconds);
        if (wanted < 0.1 * std::max(rounds.done, 0.5) && rounds.done > 0) return 0;
        if (rounds.goal.error == 0) rounds.expected = rounds.done + wanted;
    }
    return std::max(wanted, 0.05);
}

// Rounds stay large enough for a few to do, and no round wastes more than all before it; 0 when time is up.
double next_round(Rounds& rounds, const FrameStats& stats) {
    if (rounds.allotment) return next_part(rounds, stats);
    const int samples = static_cast<int>(rounds.done), batches = std::min(rounds.max_batches(), samples);
    int wanted = max_target_samples - samples;
    if (rounds.goal.error > 0) {
        rounds.expected = samples_needed(*stats.noise, samples, rounds.noise_target(), batches);
        const int least = (samples / 8 + batches - 1) / batches * batches;
        wanted = std::min(std::clamp(static_cast<int>(rounds.expected) - samples, least, samples), wanted);
    }
    if (rounds.goal.seconds > 0) {
        const double time = std::floor(std::min<double>(0.9 * rounds.left() / rounds.work_seconds, wanted));
        if (time < std::max({2, batches / 8, samples / 16})) return 0;
        wanted = static_cast<int>(time);
        if (rounds.goal.error == 0) rounds.expected = samples + wanted;
    }
    return wanted;
}

// Of an image of one sample per pixel: by what was measured on tiles beforehand, which few bright pixels escape, and by
// how far neighbours are apart.
Noise single_noise(const Choice& choice, const Layers& image) {
    const SquaredError& sample = choice.measured.sample;
    const Noise seen = noise_by_neighbours(image);
    return {std::max(std::sqrt(sample.value), seen.error), std::max(std::sqrt(sample.bound), seen.bound)};
}

// Sets what is known of the error after each round; true when it is small enough, or as small as the integrator lets it
// become.
bool judge(Rounds& rounds, const Layers& result, FrameStats& stats) {
    if (rounds.freedom > 0)
        stats.noise = noise_of(result);
    else
        stats.noise = single_noise(*rounds.choice, result);
    const double target = rounds.goal.error;
    const bool hopeless = stats.integrator && stats.integrator->error.bound >= target;
    return target > 0 && (hopeless ? stats.noise->bound <= rounds.noise_target() : stats.error()->bound <= target);
}

// Begins with what the scout shows, which counts where it is by the candidate chosen. The work that comes next; 0 when
// it is enough.
double begin_with_scout(Rounds& rounds, Layers& result, FrameStats& stats) {
    const Choice& choice = *rounds.choice;
    const Scout& scout = *choice.scout;
    const bool counts = scout.candidate.name == choice.candidate.name && scout.seed == rounds.view.seed;
    rounds.done = scout_samples, rounds.freedom = scout_samples - 1;
    if (counts) {
        rounds.work_seconds = scout.seconds / scout_samples;
        result = scout.layers, stats.add(scout.stats), stats.samples = scout_samples;
        if (judge(rounds, result, stats)) return 0;
    } else {
        const Noise noise = noise_of(scout.layers);
        const double ratio = std::sqrt(choice.noise_ratio);
        stats.noise = Noise{ratio * noise.error, ratio * noise.bound, ratio * noise.settled};
    }
    if (!begin_allotment(rounds, scout.layers, stats) && !counts) {
        const double batches = rounds.max_batches();
        double needed = max_target_samples;
        if (rounds.goal.error > 0)
            needed = scout_samples * std::pow(stats.noise->bound / rounds.noise_target(), 2 / rounds.power());
        if (rounds.goal.seconds > 0) needed = std::min(needed, rounds.left() / rounds.work_seconds);
        rounds.done = 0, rounds.freedom = 0, rounds.expected = needed;
        return std::clamp(std::ceil(needed / batches) * batches, batches, 1.0 * max_target_samples);
    }
    return next_round(rounds, stats);
}

// What a goal is likely to take from here, when so much work comes next: an allotment may be enough after its first
// part, or be begun anew. Noise falls fastest at first: the power measured there holds for about half of the way, in
// logarithms, and the rest falls as 1 / n.
double seconds_ahead(const Rounds& rounds, double next) {
    if (is_out_of_reach(*rounds.choice, rounds.goal.error)) return infinity;
    if (!(next > 0)) return rounds.check_seconds;
    const double first = rounds.choice->scout ? scout_samples : 1;
    const double samples = rounds.allotment ? rounds.allotment->rays / pixel_count(rounds.view) : rounds.expected;
    const double slower = std::pow(std::max(samples / first, 1.0), (rounds.power() - 1) / 2);
    const double work = rounds.allotment ? 1 : rounds.expected - rounds.done;
    return slower * work * rounds.work_seconds + rounds.check_seconds;
}
}

int batched_samples(int samples) { return (samples + noise_batches - 1) / noise_batches * noise_batches; }

void check_target(const Mode& mode, std::string_view option) {
    if (error_can_be_told(mode)) return;
    fail(ExitCode::usage, std::string(option),
         "mode '" + std::string(mode.name) + "' is artistic: it has no error bound; --mode auto picks one that has");
}

namespace {
// What all rounds of a picture are rendered with.
struct Rendering {
    const Mode& mode;
    const Snapshot& snapshot;
    const FrameOptions& options;
    Settings settings;
    std::shared_ptr<const Prepared> prepared; // null = each round prepares itself
};

// How far the shutter's moments are off, where there are some; the goal is left what that leaves of it.
std::optional<Noise> moments_beside(Rounds& rounds, Rendering& rendering) {
    const auto& [mode, snapshot, options, settings, prepared] = rendering;
    if (!has_moments(rounds.view, snapshot)) return {};
    if (!prepared)
        rendering.prepared =
            std::make_shared<const Prepared>(prepare_frame(mode, rounds.view, snapshot, settings, options.history));
    const std::shared_ptr<const Scout> scout = rounds.choice ? rounds.choice->scout : nullptr;
    Goal& goal = rounds.goal;
    const SquaredError error = moments_error(mode, rounds.view, snapshot, settings, *rendering.prepared,
                                             scout ? chances_in(scout->layers) : even_chances(rounds.view, snapshot),
                                             goal.error, goal.seconds > 0, options);
    const Noise moments{std::sqrt(error.value), std::sqrt(error.bound)};
    if (goal.error > 0) goal.error = error_beside(moments, goal.error).value_or(goal.error); // else it is missed
    return moments;
}

void note_integrator(const Choice& choice, FrameStats& stats) {
    if (!choice.has_integrator) return;
    const SquaredError& error = choice.measured.integrator;
    stats.integrator = {
        {std::sqrt(error.value), std::sqrt(error.bound)}, choice.candidate.name, choice.candidate.settings};
}

// Takes the choice's candidate, prepared once for all rounds.
void begin(const Choice& choice, Rounds& rounds, Rendering& rendering, FrameStats& stats) {
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

// Tells what the goal is likely to take when `more` seconds come on top of those that have passed: at first, and where
// that turns out to be wrong early on. Stats keep the last of the first third. What is far gets a limit.
void make_forecast(double more, Rounds& rounds, const FrameOptions& options, FrameStats& stats) {
    constexpr double early = 1.0 / 3, wrong = 1.5;
    const double passed = rounds.goal.clock() - rounds.start, seconds = passed + more, before = stats.forecast_seconds;
    if (before > 0 && passed > early * seconds) return;
    stats.forecast_seconds = seconds;
    if (rounds.goal.seconds == 0 && seconds > longest_seconds) rounds.goal.seconds = longest_seconds;
    const bool as_before = before > 0 && (seconds == before || (seconds < wrong * before && before < wrong * seconds));
    if (options.forecast && !as_before) options.forecast(seconds);
}

// Renders rounds until noise is as small as the goal asks for, or time is up. `round` counts those of all tries.
void render_rounds(Rounds& rounds, const Rendering& rendering, double work, Layers& result, FrameStats& stats,
                   int& round) {
    const double pixels = pixel_count(rounds.view);
    const auto& progress = rendering.options.progress;
    double begun = std::min(1.0, rounds.done / rounds.expected), rays = stats.samples * pixels; // that count
    if (rounds.done == 0) rays = 0;
    for (; work > 0; ++round) {
        std::optional<AllottedPart> part;
        if (rounds.allotment) part = part_of(*rounds.allotment, rounds.done, rounds.done + work, rounds.unit());
        const View view = rounds.round_view(work, round, part ? &*part : nullptr);
        const double reached = std::max(begun, std::min(1.0, (rounds.done + work) / rounds.expected));
        FrameOptions options = rendering.options;
        options.prepared = rendering.prepared;
        if (progress) options.progress = [&](double share) { progress(begun + share * (reached - begun)); };

        FrameStats round_stats;
        const double start = rounds.goal.clock();
        Layers layers =
            render_frame(rendering.mode, view, rendering.snapshot, rendering.settings, options, round_stats);
        rounds.work_seconds = (rounds.goal.clock() - start) / work;
        rounds.freedom += view.batches - 1, begun = reached;
        if (rounds.done == 0)
            result = std::move(layers);
        else if (part)
            blend_layers(result, layers, part->shares);
        else
            blend_layers(result, layers, static_cast<float>(work / (rounds.done + work)));
        rounds.done += work, rays += static_cast<double>(round_stats.camera_rays);
        stats.add(round_stats);
        stats.samples = static_cast<int>(std::lround(rays / pixels));

        // A picture of one sample is the end: it has no variance to go on from.
        if (judge(rounds, result, stats) || rays >= max_target_samples * pixels || rounds.freedom == 0) return;
        if (begin_allotment(rounds, result, stats)) rays = 0;
        work = next_round(rounds, stats);
        if (work == 0 || rounds.goal.error == 0) continue;
        make_forecast((rounds.expected - rounds.done) * rounds.work_seconds, rounds, rendering.options, stats);
        work = next_round(rounds, stats); // by the limit, where there is one now
    }
}
}

Layers render_to_target(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                        Goal goal, const FrameOptions& options, FrameStats& stats) {
    assert(error_can_be_told(mode) && (goal.error > 0 || goal.seconds > 0));
    if (!goal.clock) goal.clock = steady_seconds;
    const double start = goal.clock();
    const bool is_timed = goal.seconds > 0;
    const std::optional<OrdersError> orders = orders_beside(mode, view, snapshot, settings, goal, options);
    Rounds rounds = rounds_of(mode, view, goal);
    rounds.start = start;
    Rendering rendering{mode, snapshot, options, settings, nullptr};
    stats = {};
    Layers result;
    int round = 0;
    const bool measured = has_integrator(mode) || goal.seconds > 0;
    if (measured) {
        begin(choice_for(rounds, snapshot, settings, options), rounds, rendering, stats);
        stats.prepare_seconds = goal.clock() - rounds.start;
        if (rounds.choice->scout) round = 1; // none may take the random numbers of the first picture again
    }
    const std::optional<Noise> moments = moments_beside(rounds, rendering);
    for (uint32_t check = 1; check <= max_checks; ++check) {
        const bool scouted = measured && rounds.choice->scout;
        const double work = scouted ? begin_with_scout(rounds, result, stats) : first_round(rounds);
        if (goal.error > 0 && has_integrator(mode)) make_forecast(seconds_ahead(rounds, work), rounds, options, stats);
        render_rounds(rounds, rendering, work, result, stats, round);
        if (!has_integrator(mode) || (goal.seconds > 0 && rounds.check_seconds == 0)) break;

        const double until = rounds.start + goal.seconds - 0.5 * rounds.check_seconds;
        Goal asked = goal;
        if (!is_timed) asked.seconds = 0; // the limit of what is far: a finer candidate may get there in less
        const Choice after = checked(*rounds.choice, result, *stats.noise, stats.samples, until, mode, rounds.view,
                                     snapshot, settings, asked, check, options);
        if (after.candidate.name != rounds.choice->candidate.name) {
            begin(after, rounds, rendering, stats);
            continue;
        }
        rounds.choice = after;
        note_integrator(after, stats);
        const bool worth = !has_rivals(after, mode) || leaves_room(after, goal.error);
        if (goal.error > 0 && worth && rounds.freedom > 0 && !judge(rounds, result, stats))
            render_rounds(rounds, rendering, next_round(rounds, stats), result, stats, round);
        break;
    }
    stats.orders = orders, stats.moments_error = moments;
    stats.goal_seconds = goal.clock() - rounds.start;
    if (options.progress) options.progress(1);
    return result;
}
}
