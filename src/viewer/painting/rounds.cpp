#include "viewer/painting/rounds.h"

#include "base/clock.h"
#include "base/random.h"
#include "modes/mode.h"
#include "render/frame/frame.h"
#include "render/frame/layers.h"
#include "trace/transmittance/light_depth.h"
#include "trace/view.h"
#include "viewer/painting/request.h"

#include <algorithm>

namespace tyndall {
namespace {

constexpr double longest_round = 0.4; // seconds; the image is updated at least as often
constexpr int max_round_samples = 8;

// Adds a round to the mean of one half.
void add_to_half(const Layers& layers, int samples, ColorLayers& half, int& half_samples) {
    if (half_samples == 0) half = {Image<vec3>(layers.size), Image<vec3>(layers.size)};
    half_samples += samples;
    const float share = static_cast<float>(samples) / static_cast<float>(half_samples);
    for (size_t i = 0; i < half.color.pixels.size(); ++i) {
        half.color.pixels[i] += share * (layers.color.pixels[i] - half.color.pixels[i]);
        half.inscatter.pixels[i] += share * (layers.inscatter.pixels[i] - half.inscatter.pixels[i]);
    }
}

// Reuses a mode's preparation for all rounds, unless it contributes to the image's noise.
void prepare(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings, Rounds& rounds,
             FrameOptions& options, FrameStats& stats) {
    if (mode.uses_history) return;
    if (!rounds.prepared) {
        const double start = steady_seconds();
        rounds.prepared = std::make_shared<const Prepared>(prepare_frame(mode, view, snapshot, settings, nullptr));
        stats.prepare_seconds = steady_seconds() - start;
        stats.fog_seconds = rounds.prepared->mode_seconds;
    }
    options.prepared = rounds.prepared;
}
}

Round render_round(Rounds& rounds, const Mode& mode, const Request& request, const Settings& settings,
                   const Snapshot& snapshot, int samples, std::atomic<bool>& cancel) {
    View view = view_of(request);
    view.pixel_samples = samples;
    if (rounds.samples > 0) view.seed = hash(view.seed, static_cast<uint32_t>(rounds.rounds));
    FrameOptions options;
    options.cancel = &cancel;
    FrameStats preparing;
    prepare(mode, view, snapshot, settings, rounds, options, preparing);
    Round round;
    round.layers = render_frame(mode, view, snapshot, settings, options, round.stats);
    rounds.sample_seconds = round.stats.render_seconds / round.stats.samples;
    round.stats.prepare_seconds += preparing.prepare_seconds, round.stats.fog_seconds += preparing.fog_seconds;
    return round;
}

void add_round(Round round, const Request& request, Rounds& rounds) {
    const int samples = round.stats.samples;
    const size_t half = static_cast<size_t>(rounds.rounds % 2);
    if (rounds.rounds > 0) add_to_half(round.layers, samples, rounds.halves[half], rounds.half_samples[half]);
    if (rounds.samples == 0)
        rounds.layers = std::move(round.layers);
    else
        blend_layers(rounds.layers, round.layers,
                     static_cast<float>(samples) / static_cast<float>(rounds.samples + samples));
    if (rounds.rounds > 0 || request.max_samples == 1) rounds.samples += samples;
    ++rounds.rounds;
    rounds.made.push_back(samples);
}

int round_samples(const Rounds& rounds, const Request& request, const Rounds* like) {
    if (rounds.rounds == 0) return 1; // a single sample lies at the pixel's center
    const int left = request.max_samples - rounds.samples;
    const size_t number = static_cast<size_t>(rounds.rounds);
    if (like && number < like->made.size()) return std::min(like->made[number], left);
    if (rounds.samples == 0) return std::min(request.settings.pixel.samples, left);
    const double in_time = std::max(longest_round / std::max(rounds.sample_seconds, 1e-6), 2.0);
    const int samples = std::min(std::clamp(rounds.samples, 4, max_round_samples), static_cast<int>(in_time));
    return left - samples < 2 ? left : samples;
}
}
