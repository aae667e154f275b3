// Invariances of whole images: threads, crops, units of length, sums of lights, a white furnace, and two methods whose
// light transport shares hardly any code.
#include "measure/metrics/metrics.h"
#include "measure/metrics/tile_scores.h"
#include "measure/verify/rays.h"
#include "measure/verify/scaled_scene.h"

#include "base/error.h"
#include "base/parallel.h"
#include "modes/mode.h"
#include "render/frame/frame.h"
#include "scene/light.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/medium.h"

#include <cassert>

namespace tyndall {
namespace {
// What an image of a scene is rendered with, at the proof's frame.
struct Shot {
    const VerifyOptions& options;
    const VerifyControl& control;
    Checks& checks;
    Settings settings;
    bool fog_parts = false;
    int batches = 1;
    ivec2 crop_low{0}, crop_high{0};
    std::string mode = main_mode_name();
    std::function<void(double)> progress{};
};

Layers render(const Shot& shot, const Scene& scene, const Snapshot& snapshot) {
    View view;
    view.camera = camera_at(scene, find_camera(scene, shot.options.camera), snapshot.seconds);
    view.size = shot.options.size;
    view.crop_low = shot.crop_low, view.crop_high = shot.crop_high;
    view.pixel_samples = shot.settings.pixel.samples, view.batches = shot.batches;
    view.filter = shot.settings.pixel.filter, view.filter_radius = shot.settings.pixel.filter_radius;
    view.fog_parts = shot.fog_parts;
    view.seed = shot.options.seed, view.frame = shot.options.frame;
    FrameOptions options;
    options.cancel = shot.control.cancel;
    options.progress = shot.progress;
    FrameStats stats;
    Layers layers = render_frame(find_mode(shot.mode), view, snapshot, shot.settings, options, stats);
    shot.checks.non_finite += stats.non_finite;
    return layers;
}

Snapshot moment(const Scene& scene, const VerifyOptions& options) {
    return make_snapshot(scene, moment_of(scene, options.frame), nullptr, MissingFrame::error);
}

// Number of pixels whose color, fog light or transmittance differ in any bit; `offset`: where `part` is in `whole`.
int different_pixels(const Layers& part, const Layers& whole, ivec2 offset) {
    int count = 0;
    for (int y = 0; y < part.size.y; ++y)
        for (int x = 0; x < part.size.x; ++x) {
            const ivec2 p = ivec2(x, y) + offset;
            count += part.color.at(x, y) != whole.color.at(p.x, p.y) ||
                     part.inscatter.at(x, y) != whole.inscatter.at(p.x, p.y) ||
                     part.transmittance.at(x, y) != whole.transmittance.at(p.x, p.y);
        }
    return count;
}

void check_bits(const Scene& scene, const VerifyOptions& options, const VerifyControl& control, Checks& checks) {
    const Snapshot snapshot = moment(scene, options);
    for (const std::string_view mode : {main_mode().name, mode_of_all_orders().name}) {
        Shot shot{options, control, checks, settings_for(Quality::preview)};
        shot.mode = mode, shot.settings.path.orders = 2;
        const Layers whole = render(shot, scene, snapshot);
        const int threads = thread_count();
        set_thread_count(1);
        const Layers single = render(shot, scene, snapshot);
        set_thread_count(threads);
        checks.add(std::string(mode) + ": pixels that differ between 1 and " + std::to_string(threads) + " threads",
                   different_pixels(single, whole, ivec2(0)), 0, 0, "same bits");
        shot.crop_low = options.size / 4, shot.crop_high = glm::max(options.size * 3 / 4, shot.crop_low + 1);
        checks.add(std::string(mode) + ": pixels that differ between a crop and the whole",
                   different_pixels(render(shot, scene, snapshot), whole, shot.crop_low), 0, 0, "same bits");
    }
}

void check_scale(const Scene& scene, const VerifyOptions& options, const VerifyControl& control, Checks& checks) {
    const Shot shot{options, control, checks, settings_for(Quality::preview)};
    const Layers usual = render(shot, scene, moment(scene, options));
    for (const float factor : {0.5f, 64.0f}) {
        const Scene other = scaled(scene, factor);
        const Layers layers = render(shot, other, moment(other, options));
        const Errors errors = measure_errors(layers.color, usual.color);
        checks.add(factor < 1 ? "rmse_rel of everything at half the size" : "rmse_rel of everything 64 times as large",
                   relative(errors.rmse, errors.mean_reference), 0, 1e-3, "rounding");
    }
}

// The scene lit by its lights and environment alone: without ambient light and emission, which modes treat differently,
// and without background.
Scene only_lights(Scene scene) {
    scene.ambient = Keyed<vec3>(vec3(0));
    scene.background = {};
    for (Material& material : scene.materials) material.emission = vec3(0);
    for (MediumSource& medium : scene.media) {
        medium.emission = Keyed<vec3>(vec3(0)), medium.emission_grid.reset();
        medium.blackbody.reset(), medium.temperature.reset(), medium.flame.reset();
    }
    return scene;
}

void check_lights(const Scene& scene, const VerifyOptions& options, const VerifyControl& control, Checks& checks) {
    const Scene dark = only_lights(scene);
    Shot shot{options, control, checks, settings_for(Quality::preview)};
    shot.fog_parts = true;
    const Layers layers = render(shot, dark, moment(dark, options));
    shot.fog_parts = false;
    const Layers whole = render(shot, dark, moment(dark, options));
    Image<vec3> sum(layers.size, vec3(0));
    for (const auto& [name, light] : layers.lights)
        for (size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += light.pixels[i];
    for (size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] += layers.ambient.pixels[i]; // of the environment
    const Errors errors = measure_errors(sum, whole.inscatter);
    checks.add("rmse_rel of the sum over the lights' layers", relative(errors.rmse, errors.mean_reference), 0, 1e-5,
               "rounding");
}

// The scene's fog alone in uniform surroundings of radiance 1, made white, and thinned where it is too thick for paths
// to escape. Skipped for fog without bounds, which light never leaves if it is white.
void check_furnace(const Scene& scene, const VerifyOptions& options, const VerifyControl& control, Checks& checks) {
    Scene fog = only_lights(scene);
    fog.instances.clear(), fog.lights.clear(), fog.environment.reset();
    fog.ambient = Keyed<vec3>(vec3(1));
    fog.background.color = Keyed<vec3>(vec3(1));
    for (MediumSource& medium : fog.media) medium.albedo = Keyed<vec3>(vec3(1)), medium.albedo_grid.reset();
    constexpr float thick = 20; // optical depths across
    Snapshot white = moment(fog, options);
    if (!std::ranges::all_of(white.media, [](const Medium& m) { return is_finite(m.world_bounds.size()); })) return;
    for (Medium& medium : white.media) {
        const float across = medium.majorant() * glm::length(medium.world_bounds.size());
        medium.optics.extinction *= std::min(1.0f, thick / (across * static_cast<float>(white.media.size())));
    }
    Shot shot{options, control, checks, settings_for(Quality::preview)};
    shot.mode = mode_of_all_orders().name, shot.settings.pixel.samples = shot.batches = 64;
    const Layers layers = render(shot, fog, white);
    double mean = 0, variance = 0;
    const double pixels = static_cast<double>(layers.color.pixels.size());
    for (size_t i = 0; i < layers.color.pixels.size(); ++i)
        mean += layers.color.pixels[i].x / pixels, variance += layers.variance.pixels[i].x / (pixels * pixels);
    checks.add("the fog, made white, in even surroundings", mean, 1, 3 * std::sqrt(variance) + 1e-6,
               "3 standard errors");
}

void check_march(const Scene& scene, const VerifyOptions& options, const VerifyControl& control, Checks& checks) {
    const Scene lit = only_lights(scene);
    const Snapshot snapshot = moment(lit, options);
    Shot exact{options, control, checks, settings_for(Quality::reference)};
    exact.settings.pixel.filter = PixelFilter::center;
    // Only points on soft lights and in an environment are random in the reference: batches of them give the variance
    // of its mean.
    const bool soft = snapshot.environment || std::ranges::any_of(snapshot.lights, is_soft);
    exact.settings.pixel.samples = exact.batches = soft ? 8 : 1;
    // Where there is noise anyway, light is marched through grids and alpha from some nodes of each ray only: in
    // foliage and mist, marching to the sun from all of them takes a hundredth of a second, and there are millions of
    // rays.
    const int points = has_alpha_shadows(snapshot) ? 2 : 16;
    exact.settings.terms.light_points = soft ? points : 1, exact.settings.march.light_marches = soft ? 32 : 0;
    const auto part = [&](double from, double to) {
        return [&checks, from, to](double done) {
            if (checks.progress) checks.progress(from + (to - from) * done);
        };
    };
    exact.progress = part(0, 0.4);
    const Layers reference = render(exact, lit, snapshot);

    Shot noisy = exact;
    noisy.mode = mode_of_all_orders().name, noisy.settings.path.orders = 1, noisy.progress = part(0.4, 1);
    noisy.settings.pixel.samples = options.samples, noisy.batches = 64;
    const Layers layers = render(noisy, lit, snapshot);
    Image<vec3> variance = layers.variance;
    for (size_t i = 0; i < reference.variance.pixels.size(); ++i) variance.pixels[i] += reference.variance.pixels[i];
    const TileScores scores = tile_scores(layers.color, variance, reference.color);
    checks.add("score of all dark tiles together", scores.dark, 0, 4, "4 standard errors");
    if (scores.scores == 0) return;

    // The standard error of the mean of n scores is 1/√n, that of their standard deviation 1/√(2n), and 0.27 % of them
    // lie beyond 3. The channels of a tile share their random numbers: together they count as one.
    const double n = (scores.scores + 2) / 3;
    checks.add("mean score of " + std::to_string((scores.scores + 2) / 3) + " lit tiles, " +
                   std::to_string(static_cast<int>(100 * scores.precise)) + " % known to 1 %",
               scores.mean, 0, std::max(0.1, 4 / std::sqrt(n)), "0.1, or 4/sqrt(tiles)");
    checks.add("standard deviation of the scores", scores.deviation, 1, std::max(0.2, 4 / std::sqrt(2 * n)),
               "0.2, or 4/sqrt(2 tiles)");
    checks.add("share of scores within 3", scores.within_3, 1, std::max(0.005, 0.0027 + 4 * std::sqrt(0.0027 / n)),
               "0.005, or chance");
}

std::vector<CheckGroup> scene_checks(const Scene& scene, const VerifyOptions& options, const VerifyControl& control) {
    using Check = void (*)(const Scene&, const VerifyOptions&, const VerifyControl&, Checks&);
    const auto group = [&](const char* topic, double share, Check check) {
        return CheckGroup{topic, share, [&, check](Checks& checks) { check(scene, options, control, checks); }};
    };
    return {group("same bits", 2, check_bits), group("units of length", 2, check_scale),
            group("lights add up", 1, check_lights), group("white furnace", 4, check_furnace),
            group("two methods", 12, check_march)};
}
}

std::vector<Check> verify_scene(const Scene& scene, const VerifyOptions& options, const VerifyControl& control) {
    assert(!scene.media.empty());
    std::vector<CheckGroup> groups = scene_checks(scene, options, control);
    groups.push_back({"finite", 0, [](Checks& checks) {
                          checks.add("samples of all these images that were not finite numbers",
                                     static_cast<double>(checks.non_finite), 0, 0, "none");
                      }});
    return run_checks(groups, control);
}
}
