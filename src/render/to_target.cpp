#include "render/to_target.h"

#include "base/error.h"
#include "base/random.h"
#include "render/noise.h"

#include <algorithm>
#include <cassert>

namespace tyndall {
namespace {
// Into `image` a share of another one.
template<class T> void blend(Image<T>& image, const Image<T>& other, float share) {
    for (size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] += share * (other.pixels[i] - image.pixels[i]);
}

// Variance of the blended mean of independent pictures.
void blend_variance(Image<vec3>& variance, const Image<vec3>& other, float share) {
    const float kept = (1 - share) * (1 - share), added = share * share;
    for (size_t i = 0; i < variance.pixels.size(); ++i)
        variance.pixels[i] = kept * variance.pixels[i] + added * other.pixels[i];
}

void blend_layers(Layers& layers, const Layers& other, float share) {
    blend(layers.color, other.color, share);
    blend(layers.alpha, other.alpha, share);
    blend(layers.inscatter, other.inscatter, share);
    blend(layers.transmittance, other.transmittance, share);
    blend(layers.validity, other.validity, share);
    blend(layers.half_a, other.half_a, share);
    blend(layers.half_b, other.half_b, share);
    for (size_t i = 0; i < layers.lights.size(); ++i) blend(layers.lights[i].second, other.lights[i].second, share);
    blend_variance(layers.variance, other.variance, share);
    blend_variance(layers.inscatter_variance, other.inscatter_variance, share);
}

// All the samples a pixel will have taken, going by the noise after `samples`: variance falls with their number. A
// fiftieth more, so that the bound is met at the first try more often than not.
int samples_needed(const Noise& noise, int samples, double target) {
    const double ratio = noise.bound / target, needed = 1.02 * samples * ratio * ratio;
    if (!(needed < most_target_samples)) return most_target_samples;
    return std::max(batched_samples(static_cast<int>(std::ceil(needed))), samples + noise_batches);
}

// Rounds stay large enough for a few to do, and no round wastes more than all before it.
int next_round(int samples, int needed) {
    const int wanted = std::clamp(needed - samples, batched_samples(samples / 8), samples);
    return std::min(wanted, most_target_samples - samples);
}
}

int batched_samples(int samples) { return (samples + noise_batches - 1) / noise_batches * noise_batches; }

void check_target(const Mode& mode) {
    if (error_is_noise(mode)) return;
    fail(ExitCode::usage, "--target-error",
         "noise is not all that is wrong in pictures of mode '" + std::string(mode.name) +
             "', so their error cannot be told; --mode path takes it");
}

Layers render_to_target(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                        double target, const FrameOptions& options, FrameStats& stats) {
    assert(error_is_noise(mode) && target > 0);
    View round_view = view;
    round_view.batches = noise_batches;
    round_view.pixel_samples = std::min(batched_samples(view.pixel_samples), most_target_samples);

    // Until the first round has shown how noisy the scene is, all samples there may be count as work.
    double begun = 0, expected = most_target_samples;
    FrameOptions round_options = options;
    Layers result;
    stats = {};
    for (int round = 0;; ++round) {
        if (round) round_view.seed = hash(view.seed, static_cast<uint32_t>(round));
        const double share = std::min(1.0, (stats.samples + round_view.pixel_samples) / expected);
        const double reached = std::max(begun, share);
        if (options.progress)
            round_options.progress = [&](double part) { options.progress(begun + part * (reached - begun)); };

        FrameStats round_stats;
        Layers layers = render_frame(mode, round_view, snapshot, settings, round_options, round_stats);
        stats.add(round_stats);
        if (round == 0)
            result = std::move(layers);
        else
            blend_layers(result, layers, static_cast<float>(round_stats.samples) / static_cast<float>(stats.samples));
        stats.noise = noise_of(result, (noise_batches - 1) * (round + 1));
        if (stats.noise->bound <= target || stats.samples >= most_target_samples) break;

        expected = samples_needed(*stats.noise, stats.samples, target);
        round_view.pixel_samples = next_round(stats.samples, static_cast<int>(expected));
        begun = reached;
    }
    if (options.progress) options.progress(1);
    return result;
}
}
