#include "measure/chart/reference.h"

#include "base/error.h"
#include "base/io/file.h"
#include "base/random.h"
#include "base/text.h"
#include "modes/mode.h"
#include "render/adaptive/to_target.h"
#include "render/frame/frame.h"
#include "render/frame/layers.h"
#include "render/sequence/job.h"
#include "render/sequence/resume.h"
#include "scene/light.h"
#include "trace/frame_cache.h"
#include "trace/snapshot.h"
#include "trace/view.h"

#include <algorithm>

namespace tyndall {
namespace {
constexpr uint32_t half_seeds[2] = {0x52454641u, 0x52454642u}; // no image that is measured has them
constexpr uint32_t use_exact = 0xe8acu;
constexpr int exact_samples = 4; // of each pixel
const ExrOptions exact_colors{{"inscatter"}, true};

RenderRequest half_request(const Shot& shot, ReferenceSamples samples, int half) {
    RenderRequest request = shot.request;
    request.mode = main_mode().name, request.quality = Quality::reference;
    request.settings = truth_settings(request.settings);
    if (samples.count > 0) request.settings.pixel.samples = std::max(samples.count / 2, 1);
    if (samples.centers) request.settings.pixel.filter = PixelFilter::center;
    request.seed = half_seeds[half];
    request.exr = exact_colors;
    return request;
}

// The settings of the main mode that integrate fog fast enough for the goal's noise.
std::shared_ptr<const Choice> choice_for(const Shot& shot, const Snapshot& snapshot, const Goal& goal) {
    FrameOptions options;
    options.cancel = shot.cancel;
    const View view = view_of(shot.scene, shot.request, shot.request.settings, shot.frame);
    const double start = steady_seconds();
    Choice choice = choose(main_mode(), view, snapshot, shot.request.settings, goal, start, options);
    choice.measured.prepared = nullptr, choice.scout = nullptr; // each half has its own
    return std::make_shared<const Choice>(std::move(choice));
}

Goal goal_of(const Shot& shot, ReferenceSamples samples) {
    return {std::sqrt(2.0) * samples.noise, samples.seconds, shot.request.quality, steady_seconds};
}

// Half of a reference rendered to a target noise, by two-level Monte Carlo (Heinrich 2001, multilevel Monte Carlo):
// many fast samples, plus the mean difference between exact and fast ones, whose variance is low, from a few.
Layers half_by_noise(const Shot& shot, const Snapshot& snapshot, const RenderRequest& request, View view,
                     const Goal& goal, const FrameOptions& options, FrameStats& stats) {
    const Mode& mode = find_mode(request.mode);
    const Settings& quick = goal.choice->candidate.settings;
    Layers result = render_to_target(mode, view, snapshot, quick, goal, options, stats);

    view.seed = hash(view.seed, use_exact);
    view.pixel_samples = exact_samples, view.batches = view.lamp_samples = view.edge_samples = 1;
    FrameOptions plain;
    plain.cancel = shot.cancel;
    FrameStats ignored;
    const Layers exact = render_frame(mode, view, snapshot, request.settings, plain, ignored);
    const Layers rough = render_frame(mode, view, snapshot, quick, plain, ignored);
    for (size_t i = 0; i < result.color.pixels.size(); ++i) {
        result.color.pixels[i] += exact.color.pixels[i] - rough.color.pixels[i];
        result.inscatter.pixels[i] += exact.inscatter.pixels[i] - rough.inscatter.pixels[i];
    }
    return result;
}

// The image asked for, rendered or read from the file of an earlier run. Sets goal->choice when it is first needed.
ColorLayers rendered(const Shot& shot, const Snapshot& snapshot, const RenderRequest& request, Goal* goal,
                     const std::string& name, std::string hash, const std::function<void(double)>& progress) {
    const View view = view_of(shot.scene, request, request.settings, shot.frame);
    const std::filesystem::path file = shot.directory / (name + ".exr");
    if (!shot.directory.empty()) {
        std::string why;
        std::vector<std::string> channels = channel_names({}, false, exact_colors);
        if (const auto kept = finished_frame(file, {view.size, ivec2(0), view.size, channels, hash}, why))
            return {color_of(*kept), color_of(*kept, "inscatter")};
    }
    FrameOptions options;
    options.cancel = shot.cancel, options.progress = progress;
    FrameStats stats;
    const Snapshot own = fresh(snapshot);
    if (goal && !goal->choice) goal->choice = choice_for(shot, own, *goal);
    Layers layers = goal ? half_by_noise(shot, own, request, view, *goal, options, stats)
                         : render_frame(find_mode(request.mode), view, own, request.settings, options, stats);
    if (!shot.directory.empty()) {
        RenderRequest named = request;
        named.output = file.string();
        Provenance provenance = provenance_of(shot.scene, named, requested_plan(request), view, hash, stats);
        write_exr(file, layers, provenance, exact_colors);
    }
    return {std::move(layers.color), std::move(layers.inscatter)};
}

std::string half_hash(const Shot& shot, const RenderRequest& request, ReferenceSamples samples, FileHashes& files) {
    const std::string hash = frame_hash(shot.scene, request, requested_plan(request),
                                        view_of(shot.scene, request, request.settings, shot.frame), files);
    return samples.count > 0 ? hash : content_hash(hash + formatted("%.9g %.9g", samples.noise, samples.seconds));
}
}

Snapshot fresh(const Snapshot& snapshot) {
    Snapshot result = snapshot;
    result.cache = std::make_shared<FrameCache>(), result.previous_cache = nullptr;
    return result;
}

std::string reference_hash(const Shot& shot, ReferenceSamples samples, FileHashes& files) {
    return content_hash(half_hash(shot, half_request(shot, samples, 0), samples, files) +
                        half_hash(shot, half_request(shot, samples, 1), samples, files));
}

double reference_seconds(const Shot& shot, ReferenceSamples samples) {
    const std::shared_ptr<const Choice> choice = choice_for(shot, fresh(shot.snapshot), goal_of(shot, samples));
    const Measurement& measured = choice->measured;
    if (samples.count > 0) return samples.count * choice->pilot->truth_seconds();
    const double needed = std::pow(measured.sample.value / (2 * samples.noise * samples.noise), 1 / choice->power);
    const double quick = std::min(measured.prepare_seconds + needed * measured.sample_seconds, samples.seconds);
    return 2 * (quick + exact_samples * (measured.sample_seconds + choice->pilot->truth_seconds()));
}

Reference make_reference(const Shot& shot, ReferenceSamples samples, FileHashes& files) {
    Snapshot unlit = shot.snapshot;
    unlit.lights.clear();
    const bool chance = !samples.centers || std::ranges::any_of(shot.snapshot.lights, is_soft);
    const std::string prefix = (samples.centers ? "centers." : "picture.") + std::to_string(shot.request.resolution.x) +
                               "x" + std::to_string(shot.request.resolution.y) + "." + std::to_string(shot.frame);
    const bool by_noise = samples.count == 0;
    Goal goal = goal_of(shot, samples), unlit_goal = goal; // both halves use the same choice
    Reference result;
    for (size_t half = 0; half < 2; ++half) {
        if (half == 1 && !chance) {
            result.halves[1] = result.halves[0], result.unlit[1] = result.unlit[0];
            break;
        }
        const auto part = [&](double done) {
            if (shot.progress) shot.progress((static_cast<double>(half) + done) / (chance ? 2 : 1));
        };
        const RenderRequest request = half_request(shot, samples, static_cast<int>(half));
        const std::string hash = half_hash(shot, request, samples, files), name = prefix + (half ? ".b" : ".a");
        result.halves[half] = rendered(shot, shot.snapshot, request, by_noise ? &goal : nullptr, name, hash, part);
        if (samples.unlit)
            result.unlit[half] = rendered(shot, unlit, request, by_noise ? &unlit_goal : nullptr, name + ".unlit",
                                          content_hash(hash + "unlit"), {});
    }
    return result;
}

ColorLayers mean_of(const std::array<ColorLayers, 2>& halves) {
    ColorLayers mean = halves[0];
    for (size_t i = 0; i < mean.color.pixels.size(); ++i) {
        mean.color.pixels[i] = 0.5f * (mean.color.pixels[i] + halves[1].color.pixels[i]);
        mean.inscatter.pixels[i] = 0.5f * (mean.inscatter.pixels[i] + halves[1].inscatter.pixels[i]);
    }
    return mean;
}
}
