#include "render/adaptive/target_rounds.h"

#include "render/frame/layers.h"

#include <algorithm>
#include <cmath>

namespace tyndall {
namespace {
// Most samples per pixel in a first round: an image that needs more than sixteen times as many has pixels with far more
// variance than others, which show by then.
constexpr double max_first_samples = 64;
constexpr double early_share = 0.2; // of an image, for the first round of one that is checked early
constexpr double many_times = 8; // the work of two samples in all pixels: what an allotment must exceed to pay for them

// Total samples per pixel to reach `target`, given the noise after `samples`: variance falls as 1 / n. A fiftieth more,
// so that the bound is usually met at the first try.
int samples_needed(const Noise& noise, int samples, double target, int batches) {
    const double ratio = noise.bound / target, needed = 1.02 * samples * ratio * ratio;
    if (!(needed < max_target_samples)) return max_target_samples;
    const int whole = (static_cast<int>(std::ceil(needed)) + batches - 1) / batches * batches;
    return std::max(whole, samples + batches);
}
}

double pixel_count(const View& view) {
    const ivec2 size = view.crop_low == view.crop_high ? view.size : view.crop_high - view.crop_low;
    return static_cast<double>(size.x) * size.y;
}

bool is_out_of_reach(const Choice& choice, double error) {
    return choice.has_integrator && choice.measured.integrator.bound >= error * error;
}

int first_round(TargetRounds& rounds) {
    if (!rounds.choice) return std::min(batched_samples(rounds.view.pixel_samples), max_target_samples);
    const Measurement& measured = rounds.choice->measured;
    int samples = max_target_samples;
    if (rounds.goal.error > 0) {
        const double ratio = measured.sample.value / std::pow(rounds.noise_target(), 2);
        const double needed = std::pow(ratio, 1 / rounds.choice->power);
        samples = static_cast<int>(std::clamp(std::ceil(needed / 16), 4.0, max_first_samples));
        if (needed < 8) samples = std::max(static_cast<int>(std::ceil(needed / 2)), 2);
        rounds.expected = std::max<double>(samples, std::min<double>(needed, max_target_samples));
    }
    if (rounds.goal.seconds > 0) {
        // Two samples show where an image has variance, which is worth more than a check of the integrator.
        if (rounds.left() < 2 * rounds.work_seconds) rounds.check_seconds = 0;
        const double time = std::floor(std::min(rounds.left() / rounds.work_seconds, 0.0 + max_target_samples));
        samples = std::min(samples, static_cast<int>(std::max(time > 32 ? time / 8 : time > 4 ? time / 2 : time, 1.0)));
        rounds.expected = std::min(rounds.expected, std::max(time, 1.0));
    }
    return std::max(samples, rounds.fewest());
}

namespace {
// Work to make the image as accurate as an allotment would, by continuing as before.
double work_as_it_goes(const TargetRounds& rounds, const Allotment& allotment, const Noise& noise) {
    // An allotment has few batches: what it missed shows in the bound, so compare bounds if the goal is within reach.
    const double target = rounds.noise_target() * rounds.noise_target();
    const auto more = [&](double ratio) { return rounds.done * (std::pow(ratio, 1 / rounds.power_of_parts()) - 1); };
    if (rounds.allotment && allotment.squared_bound <= target) return more(noise.bound * noise.bound / target);
    return more(noise.error * noise.error / allotment.squared_error);
}
}

// If many more samples are to come, a part of them first shows how fast noise falls: as n^-1 at worst, as was assumed,
// but often as n^-1.5, so that the cube root of their growth is too much.
bool begin_allotment(TargetRounds& rounds, const Layers& layers, FrameStats& stats) {
    const Noise& noise = *stats.noise;
    if (rounds.freedom == 0 || !(noise.error > 0) || !std::isfinite(noise.bound)) return false;
    const double unit_rays = rounds.allotment ? rounds.allotment->rays : pixel_count(rounds.view);
    const double ray_seconds = rounds.work_seconds / unit_rays;
    AllotLimits limits{0, max_target_samples * pixel_count(rounds.view)};
    if (rounds.goal.error > 0)
        limits.squared_error = infinity, limits.squared_bound = std::pow(rounds.noise_target(), 2) / 1.05;
    if (rounds.goal.seconds > 0) limits.rays = std::min(limits.rays, std::max(0.9 * rounds.left() / ray_seconds, 0.0));
    const Image<float> taken = rounds.samples_taken(layers);
    const Allotment allotment = allot(layers, taken, limits, rounds.power(), rounds.unit());

    // Work for the same result by continuing with independent rounds instead of starting over.
    const double as_it_goes = work_as_it_goes(rounds, allotment, noise) * unit_rays;
    const double gain = rounds.allotment ? 2 : 1.2;
    if (!(gain * allotment.rays < as_it_goes) || allotment.rays > 1.1 * limits.rays) return false;
    rounds.work_seconds = ray_seconds * allotment.rays;
    double growth = 0;
    for (size_t i = 0; i < taken.pixels.size(); ++i)
        growth = std::max(growth, double{allotment.samples.pixels[i]} / taken.pixels[i]);
    const bool again = rounds.allotment.has_value();
    rounds.allotment = allotment, rounds.done = 0, rounds.freedom = 0, rounds.expected = 1;
    const double part = std::min(rounds.continues() ? 0.2 : 0.4, 4 / std::cbrt(growth));
    rounds.first_part = rounds.checks_early() ? early_share : again || growth > 16 ? part : 1;
    return true;
}

namespace {
// The next part of an allotment: what the noise requires and the time allows; 0 when time is up.
double next_part(TargetRounds& rounds, const FrameStats& stats) {
    double wanted = rounds.goal.error > 0 ? rounds.first_part : 1;
    if (rounds.done > 0 && rounds.goal.error > 0) {
        const double ratio = stats.noise->bound / rounds.noise_target();
        rounds.expected = 1.02 * rounds.done * std::pow(ratio, 2 / rounds.power_of_parts());
        wanted = std::clamp(rounds.expected - rounds.done, 0.125 * rounds.done, rounds.done);
    }
    if (rounds.goal.seconds > 0) {
        // Tiles with the most samples may also cost more per sample: leave a margin until the first part shows it.
        const double safe = rounds.done > 0 ? 0.9 : 0.5;
        wanted = std::min(wanted, safe * rounds.left() / rounds.work_seconds);
        if (wanted < 0.1 * std::max(rounds.done, 0.5) && rounds.done > 0) return 0;
        if (rounds.goal.error == 0) rounds.expected = rounds.done + wanted;
    }
    return std::max(wanted, 0.05);
}
}

double next_round(TargetRounds& rounds, const FrameStats& stats) {
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

namespace {
// Noise of an image with one sample per pixel: the larger of what was measured on tiles beforehand, which may miss a
// few bright pixels, and an estimate from differences between neighbors.
Noise single_noise(const Choice& choice, const Layers& image) {
    const SquaredError& sample = choice.measured.sample;
    const Noise seen = noise_by_neighbors(image);
    return {std::max(std::sqrt(sample.value), seen.error), std::max(std::sqrt(sample.bound), seen.bound)};
}
}

bool judge(TargetRounds& rounds, const Layers& result, FrameStats& stats) {
    if (rounds.freedom > 0)
        stats.noise = noise_of(result);
    else
        stats.noise = single_noise(*rounds.choice, result);
    const double target = rounds.goal.error;
    const bool hopeless = stats.integrator && stats.integrator->error.bound >= target;
    return target > 0 && (hopeless ? stats.noise->bound <= rounds.noise_target() : stats.error()->bound <= target);
}

double begin_with_scout(TargetRounds& rounds, FrameStats& stats) {
    const Choice& choice = *rounds.choice;
    rounds.done = scout_samples, rounds.freedom = scout_samples - 1;
    const Noise noise = noise_of(choice.scout->layers);
    const double ratio = std::sqrt(choice.noise_ratio), sample_seconds = rounds.work_seconds;
    stats.noise = Noise{ratio * noise.error, ratio * noise.bound, ratio * noise.settled};
    double most = max_first_samples, expected = max_target_samples;
    if (rounds.goal.error > 0)
        expected = scout_samples * std::pow(stats.noise->bound / rounds.noise_target(), 2 / rounds.power());
    // Where few pixels hold the noise, the scout may have missed some, and where many samples are to come, it pays to
    // know better: then all pixels take two samples first, whose allotment follows.
    if (begin_allotment(rounds, choice.scout->layers, stats)) {
        most = scout_samples, expected = rounds.allotment->rays / pixel_count(rounds.view);
        if (expected < many_times * most && rounds.allotment->pixels >= many_pixels) return next_round(rounds, stats);
        rounds.allotment.reset(), rounds.first_part = 1, rounds.work_seconds = sample_seconds;
    }

    if (rounds.goal.seconds > 0) expected = std::min(expected, rounds.left() / rounds.work_seconds);
    rounds.done = 0, rounds.freedom = 0, rounds.expected = expected;
    const double batches = rounds.max_batches(), share = rounds.checks_early() ? early_share : 1;
    return std::clamp(std::ceil(share * expected / batches) * batches, batches, std::max(most, batches));
}

double seconds_ahead(const TargetRounds& rounds, double next) {
    if (is_out_of_reach(*rounds.choice, rounds.goal.error)) return infinity;
    if (!(next > 0)) return rounds.check_seconds;
    const double first = rounds.choice->scout ? scout_samples : 1;
    const double samples = rounds.allotment ? rounds.allotment->rays / pixel_count(rounds.view) : rounds.expected;
    const double slower = std::pow(std::max(samples / first, 1.0), (rounds.power() - 1) / 2);
    const double work = rounds.allotment ? 1 : rounds.expected - rounds.done;
    return slower * work * rounds.work_seconds + rounds.check_seconds;
}
}
