#include "render/adaptive/planned.h"

#include "base/clock.h"
#include "base/random.h"
#include "modes/mode.h"
#include "render/adaptive/check.h"
#include "render/adaptive/errors/orders.h"
#include "render/adaptive/errors/shutter_error.h"
#include "render/adaptive/to_target.h"
#include "trace/transmittance/light_depth.h"
#include "trace/view.h"

#include <algorithm>

namespace tyndall {
namespace {
constexpr int pilot_samples = 8;    // per pixel, independent of each other
constexpr uint32_t image_check = 1; // salt for the tiles of a finished image; those of earlier checks follow it
constexpr int64_t max_shown_pixels = 1 << 21;
constexpr uint32_t use_pilot = 0x9170u; // the frame's samples are independent of those it is planned from

FrameOptions without_report(const FrameOptions& options) {
    FrameOptions result = options;
    result.halves = false, result.progress = nullptr, result.forecast = nullptr;
    return result;
}

std::shared_ptr<const TileFactors> counts_of(const Allotment& allotment, int groups) {
    auto counts =
        std::make_shared<TileFactors>(TileFactors{allotment.low, Image<uint16_t>(allotment.samples.size, uint16_t{1})});
    for (size_t i = 0; i < allotment.samples.pixels.size(); ++i)
        counts->factors.pixels[i] = static_cast<uint16_t>(
            std::clamp(std::ceil(allotment.samples.pixels[i] / static_cast<float>(groups)), 1.0f, 65535.0f));
    return counts;
}

// The frame's view with the same number of samples in all pixels.
View even_frame(const View& view) {
    View even = uniform_view(view, 1, 1);
    even.leaves = 0, even.allotted = nullptr;
    return even;
}

struct PilotImage {
    Layers layers;
    FrameStats stats;
};

// Rendered with the candidate, if there is one.
PilotImage pilot_image(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                       const std::optional<Choice>& choice, const FrameOptions& options) {
    View even = uniform_view(even_frame(view), pilot_samples, pilot_samples);
    even.seed = hash(view.seed, use_pilot);
    FrameOptions prepared = options;
    if (choice) prepared.prepared = choice->measured.prepared;
    PilotImage pilot;
    pilot.layers =
        render_frame(mode, even, snapshot, choice ? choice->candidate.settings : settings, prepared, pilot.stats);
    return pilot;
}

void note_choice(const Choice& choice, PlannedSamples& planned) {
    planned.settings = choice.candidate.settings, planned.error.is_truth = choice.is_truth;
    const SquaredError& error = choice.measured.integrator;
    if (choice.has_integrator)
        planned.error.integrator = {
            {std::sqrt(error.value), std::sqrt(error.bound)}, choice.candidate.name, planned.settings};
}

// Error of motion blur, if the frame has any; on tiles drawn by what an image shows, or evenly if it is empty.
std::optional<Noise> moments_of_frame(const Mode& mode, const View& view, const Snapshot& snapshot,
                                      const Settings& settings, std::shared_ptr<const Prepared> prepared,
                                      const Layers& image, double error, const FrameOptions& options) {
    if (!has_moments(view, snapshot)) return {};
    const View even = even_frame(view);
    if (!prepared)
        prepared = std::make_shared<const Prepared>(prepare_frame(mode, even, snapshot, settings, options.history));
    const TileChances chances = image.variance.empty() ? uniform_chances(even, snapshot) : chances_in(image);
    const SquaredError squared =
        moments_error(mode, even, snapshot, settings, *prepared, chances, error, false, options);
    return Noise{std::sqrt(squared.value), std::sqrt(squared.bound)};
}

double mean_of(const TileFactors& counts) {
    double sum = 0;
    for (const uint16_t count : counts.factors.pixels) sum += count;
    return sum / static_cast<double>(counts.factors.pixels.size());
}
}

PlannedSamples plan_samples(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                            const Goal& asked, const FrameOptions& given) {
    const FrameOptions options = without_report(given);
    Goal goal = asked;
    if (!goal.clock) goal.clock = steady_seconds;
    PlannedSamples planned{settings, nullptr, {goal.error, {}, false, {}}};
    planned.error.orders = measure_orders(mode, view, snapshot, settings, goal, options);

    std::optional<Choice> choice;
    if (has_integrator(mode))
        choice = goal.choice ? *goal.choice : choose(mode, view, snapshot, settings, goal, goal.clock(), options);
    PilotImage pilot = pilot_image(mode, view, snapshot, settings, choice, options);
    planned.error.moments =
        moments_of_frame(mode, view, snapshot, choice ? choice->candidate.settings : settings,
                         choice ? choice->measured.prepared : nullptr, pilot.layers, goal.error, options);
    if (const auto& moments = planned.error.moments) {
        planned.wanted_moments = moments_for(*moments, static_cast<int>(view.shutter->cameras.size()), goal);
        if (planned.wanted_moments > 0) return planned;
        goal.error = remaining_error(*moments, goal.error).value_or(goal.error); // none = goal missed
    }
    for (uint32_t check = 1; choice && check <= max_checks; ++check) {
        const double bound = noise_target(*choice, goal.error), work = choice->work_to(goal.error);
        const Noise noise{bound, bound, bound};
        const double samples = work < infinity ? work / choice->measured.sample_work : pilot_samples;
        const Choice after = check_choice(*choice, {pilot.layers, noise, samples, 0}, infinity, mode, even_frame(view),
                                          snapshot, settings, goal, image_check + check, options);
        const bool finer = after.candidate.name != choice->candidate.name;
        choice = after;
        if (!finer) break;
        pilot = pilot_image(mode, view, snapshot, settings, choice, options);
    }
    if (choice) note_choice(*choice, planned);
    const double target = choice ? noise_target(*choice, goal.error) : goal.error;
    const Layers& layers = pilot.layers;
    const FrameStats& stats = pilot.stats;

    // Noise falls fastest at first: use the measured power for half of the way and 1 / n for the rest.
    const double power = choice ? (1 + std::clamp(choice->power, 1.0, 1.5)) / 2 : 1;
    const double pixels = static_cast<double>(layers.color.pixels.size());
    const AllotLimits limits{infinity, max_target_samples * pixels, target * target / 1.05};
    planned.counts = counts_of(allot(layers, pilot_samples, limits, power, view.batches), view.batches);
    planned.samples = view.batches * mean_of(*planned.counts);
    planned.seconds = stats.render_seconds / pilot_samples * planned.samples;
    return planned;
}

namespace {
// Integrator error on tiles where an image shows that it is likely; does not look for a finer candidate.
Integrator measured_integrator(const Choice& choice, double target, const Mode& mode, const View& view,
                               const Snapshot& snapshot, const Layers& image, const Noise& noise, double samples,
                               uint32_t salt, const FrameOptions& options) {
    Goal goal{target, infinity, Quality::preview};
    goal.clock = steady_seconds;
    const Settings& settings = choice.candidate.settings;
    const Choice after = check_choice(choice, {image, noise, samples, samples}, infinity, mode, even_frame(view),
                                      snapshot, settings, goal, salt, options);
    const SquaredError& error = after.measured.integrator;
    return {{std::sqrt(error.value), std::sqrt(error.bound)}, choice.candidate.name, settings};
}

Choice choice_of(const std::string& candidate, const Settings& settings, const Noise& integrator) {
    Choice choice;
    choice.candidate = {candidate, settings}, choice.has_integrator = true;
    choice.measured.integrator.value = integrator.error * integrator.error;
    choice.measured.integrator.bound = integrator.bound * integrator.bound;
    return choice;
}
}

PlannedError systematic_error(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                              const FrameOptions& given) {
    const FrameOptions options = without_report(given);
    PlannedError error;
    if (takes_fluence(mode, settings)) error.orders = orders_error(mode, view, snapshot, settings, 0, options);
    if (!has_integrator(mode)) {
        error.moments = moments_of_frame(mode, view, snapshot, settings, nullptr, {}, 0, options);
        return error;
    }
    Layers image; // shows where errors are likely; if it would take long to render, tiles are drawn evenly
    if (static_cast<int64_t>(view.size.x) * view.size.y <= max_shown_pixels) {
        View few = uniform_view(even_frame(view), scout_samples, scout_samples);
        few.seed = hash(view.seed, use_pilot);
        FrameStats stats;
        image = render_frame(mode, few, snapshot, settings, options, stats);
    }
    error.integrator = measured_integrator(choice_of("as set", settings, {}), 0, mode, view, snapshot, image, {}, 1,
                                           image_check, options);
    error.moments = moments_of_frame(mode, view, snapshot, settings, nullptr, image, 0, options);
    return error;
}

void add_planned_error(const PlannedError& planned, const Mode& mode, const View& view, const Snapshot& snapshot,
                       const Settings& settings, const Layers& image, const FrameOptions& options, FrameStats& stats) {
    if (!stats.noise) return;
    if (planned.orders) stats.orders = planned.orders;
    if (planned.moments) stats.moments_error = planned.moments;
    if (planned.integrator) stats.integrator = planned.integrator;
    if (!planned.is_checked()) return;
    const Integrator& before = *planned.integrator;
    stats.integrator =
        measured_integrator(choice_of(before.candidate, settings, before.error), planned.target, mode, view, snapshot,
                            image, *stats.noise, stats.samples, image_check, without_report(options));
}

double missing_groups(const PlannedError& planned, const FrameStats& stats, int groups) {
    if (planned.target == 0 || !stats.noise || stats.error()->bound <= planned.target) return 0;
    const double all = stats.error()->bound, noise = stats.noise->bound;
    const double left = planned.target * planned.target - (all * all - noise * noise);
    if (!(left > 0)) return infinity;
    return std::max(std::ceil(1.05 * groups * noise * noise / left) - groups, 1.0);
}
}
