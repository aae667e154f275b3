// Renders the tiny scenes of the stress suite, counts invalid values, and measures errors.
#include "measure/stress/trial.h"
#include "modes/froxel/settings.h"

#include "measure/metrics/halves.h"
#include "measure/metrics/metrics.h"
#include "modes/light_filters.h"
#include "modes/mode.h"
#include "render/adaptive/candidates.h"
#include "scene/light.h"
#include "scene/mesh.h"
#include "scene/scene.h"
#include "trace/occlusion/occluders.h"
#include "volume/bricks/sparse_volume.h"
#include "volume/medium.h"
#include "volume/phase.h"

namespace tyndall {
namespace {
// Samples per pixel if noise is the only error; fewer in error_and_bias().
constexpr int max_samples = 1024, max_authored = 256;

uint64_t negative_in(const Image<vec3>& image) {
    return static_cast<uint64_t>(std::ranges::count_if(
        image.pixels, [](vec3 value) { return std::min(value.x, std::min(value.y, value.z)) < 0; }));
}

// Values that are not between 0 and 1.
uint64_t no_share_in(const Image<float>& image) {
    constexpr float rounding = 1e-5f;
    return static_cast<uint64_t>(
        std::ranges::count_if(image.pixels, [](float value) { return !(value >= 0 && value <= 1 + rounding); }));
}

uint64_t non_finite_in(const Image<vec3>& image) {
    return static_cast<uint64_t>(std::ranges::count_if(image.pixels, [](vec3 value) { return !is_finite(value); }));
}

// Whether every image of the scene is randomly sampled, over the lens or within the shutter interval.
bool is_blurred(const StressScene& scene) { return scene.view.camera.lens || scene.view.shutter; }

// Whether the scene has light that a march samples randomly: environment, emissive surfaces, area lights or fog.
bool has_sampled_light(const Snapshot& snapshot) {
    const bool glowing = snapshot.scene && std::ranges::any_of(snapshot.scene->materials, [](const Material& material) {
                             return max_component(material.emission) > 0;
                         });
    return snapshot.environment || glowing ||
           std::ranges::any_of(snapshot.lights, [](const Light& light) { return light.area != nullptr; }) ||
           std::ranges::any_of(snapshot.media,
                               [](const Medium& medium) { return max_component(medium.optics.emission.radiance) > 0; });
}

// Whether an image's only error is noise: a march samples soft lights randomly, as path tracing does, and several modes
// sample gobos randomly.
bool is_noise(const Trial& trial) {
    const Snapshot& snapshot = trial.scene.snapshot;
    const bool shadows = snapshot.occluders && !snapshot.occluders->empty();
    if (is_unbiased(*trial.mode) || is_blurred(trial.scene)) return true;
    if (trial.mode->samples_soft_lights && has_sampled_light(snapshot)) return true;
    if (trial.mode->samples_soft_lights && shadows && std::ranges::any_of(snapshot.lights, is_soft)) return true;
    const Limitations said = trial.mode->limitations(trial.scene.view, snapshot, trial.scene.settings);
    return std::ranges::any_of(said, [](const Limitation& one) { return one.is(limitation::sampled_gobo); });
}

// Depths that are negative or NaN; infinite ones are those of the background.
uint64_t no_depth_in(const Image<float>& depth) {
    return static_cast<uint64_t>(std::ranges::count_if(depth.pixels, [](float value) { return !(value >= 0); }));
}

void count_faults(const Layers& layers, const FrameStats& stats, Faults& faults) {
    faults.non_finite += stats.non_finite + non_finite_in(layers.color) + non_finite_in(layers.inscatter);
    faults.negative += negative_in(layers.color) + negative_in(layers.inscatter) + no_share_in(layers.alpha) +
                       no_share_in(layers.transmittance) + no_share_in(layers.validity) + no_depth_in(layers.depth);
    for (const auto& [name, light] : layers.lights)
        faults.non_finite += non_finite_in(light), faults.negative += negative_in(light);
}

// Squared bias estimated from two independent images, and two standard errors of it; both relative to the squared mean
// of the ground truth.
struct Bias {
    double squared = 0, doubt = 0;
};
Bias bias_of(const Image<vec3>& a, const Image<vec3>& b, const Image<vec3>& truth, const Image<vec3>& again) {
    const Estimate squared = product_of_errors(a, b, truth, again);
    const double unit = mean_of(truth) * mean_of(truth);
    return {relative(squared.value, unit), relative(2 * squared.standard_error, unit)};
}

// Relative difference between the means of two pairs of images, less two standard errors estimated within the pairs.
double bias_of_means(const Image<vec3>& a, const Image<vec3>& b, const Image<vec3>& truth, const Image<vec3>& again) {
    const auto spread = [](const Image<vec3>& one, const Image<vec3>& other) {
        double squares = 0;
        for (size_t i = 0; i < one.pixels.size(); ++i) {
            const dvec3 off = dvec3(one.pixels[i]) - dvec3(other.pixels[i]);
            squares += std::pow((off.x + off.y + off.z) / 3, 2);
        }
        return 0.5 * std::sqrt(squares) / static_cast<double>(one.pixels.size());
    };
    const double right = 0.5 * (mean_of(truth) + mean_of(again)), found = 0.5 * (mean_of(a) + mean_of(b));
    const double doubt = 2 * std::hypot(spread(a, b), spread(truth, again));
    return relative(std::max(0.0, std::abs(found - right) - doubt), right);
}

// A lower bound of the bias, from enough samples to show a bias as large as the allowed error. If max_taken samples are
// too few for that, an upper bound, or the lower bound all the same unless `doubted`.
double bias_to_truth(Trial& trial, int max_taken = max_samples, bool doubted = true) {
    const Layers &truth = trial.truth(), &other = trial.other_truth();
    StressScene again = trial.scene;
    again.view.seed += 1;
    const double allowed = trial.allowed * trial.allowed;
    for (;; trial.noisy_samples *= 2) {
        const Layers a = trial.render(), b = trial.render(again);
        const Bias both[] = {bias_of(a.color, b.color, truth.color, other.color),
                             bias_of(a.inscatter, b.inscatter, truth.inscatter, other.inscatter)};
        trial.bias = bias_of_means(a.inscatter, b.inscatter, truth.inscatter, other.inscatter);
        double least = 0, most = 0, doubt = 0;
        for (const Bias& bias : both) {
            least = std::max(least, bias.squared - bias.doubt), doubt = std::max(doubt, bias.doubt);
            most = std::max(most, std::max(bias.squared, 0.0) + bias.doubt);
        }
        if (doubt <= allowed || least > allowed) return std::sqrt(least);
        if (trial.noisy_samples >= max_taken) return std::sqrt(doubted ? most : least);
        // The standard error of the product of two noise errors is inversely proportional to the sample count.
        while (2 * trial.noisy_samples < max_taken && doubt > 2 * allowed) doubt /= 2, trial.noisy_samples *= 2;
    }
}

// The same for the mean fog light.
double bias_of_mean(Trial& trial) {
    constexpr int pictures = 8;
    const double truth = mean_of(trial.truth().inscatter);
    for (;; trial.noisy_samples *= 4) {
        double mean = 0, squares = 0;
        StressScene scene = trial.scene;
        for (int i = 0; i < pictures; ++i, ++scene.view.seed) {
            const double off = mean_of(trial.render(scene).inscatter) / truth - 1;
            mean += off / pictures, squares += off * off;
        }
        const double variance = std::max(0.0, squares / pictures - mean * mean);
        const double doubt = 2 * std::sqrt(variance / (pictures - 1));
        const double least = std::abs(mean) - doubt;
        if (doubt <= 0.5 * trial.allowed || least > trial.allowed) return std::max(0.0, least);
        if (trial.noisy_samples >= max_samples) return std::abs(mean) + doubt;
    }
}
}

Layers Trial::render(const StressScene& what, History* history, bool parts) {
    View view = what.view;
    view.fog_parts = parts;
    if (is_noise(*this)) view.pixel_samples = noisy_samples;
    FrameOptions options;
    options.cancel = cancel, options.history = history;
    FrameStats stats;
    Layers layers = render_frame(*mode, view, what.snapshot, what.settings, options, stats);
    count_faults(layers, stats, faults);
    return layers;
}

Layers Trial::truth_of_scene(const StressScene& what) {
    Settings settings = truth_settings(what.settings);
    View view = what.view;
    if (std::ranges::any_of(what.snapshot.lights, is_soft)) settings.terms.light_points = 16, view.pixel_samples = 8;
    FrameOptions options;
    options.cancel = cancel;
    FrameStats stats;
    Layers layers = render_frame(main_mode(), view, what.snapshot, settings, options, stats);
    count_faults(layers, stats, faults);
    return layers;
}

namespace {
// A march at quality final with marched light transmittance, at the given samples per pixel and seed.
Layers sampled_truth(Trial& trial, int samples, uint32_t seed) {
    const StressScene& what = trial.scene.finer ? *trial.scene.finer : trial.scene;
    Settings settings = what.settings;
    const Settings careful = settings_for(Quality::final);
    settings.march = careful.march, settings.terms = careful.terms;
    settings.terms.light = LightTransmittance::marched;
    View view = what.view;
    view.pixel_samples = samples, view.seed += seed;
    FrameOptions options;
    options.cancel = trial.cancel;
    FrameStats stats;
    Layers layers = render_frame(main_mode(), view, what.snapshot, settings, options, stats);
    count_faults(layers, stats, trial.faults);
    return layers;
}

// Two images with enough samples to bring their noise near the error allowed to modes: the product of the errors
// against both is unbiased by it.
Truth sampled_truths(Trial& trial) {
    constexpr double noise = 0.15;
    for (int samples = 64;; samples *= 2) {
        Layers first = sampled_truth(trial, samples, 1001), second = sampled_truth(trial, samples, 1002);
        if (2 * samples > max_samples || difference(first, second) < std::numbers::sqrt2 * noise)
            return {std::move(first), {}, std::move(second)};
    }
}
}

const Layers& Trial::truth() {
    if (!known_truth) {
        const Faults own = std::exchange(faults, {});
        const bool sampled = is_blurred(scene) || has_sampled_light(scene.snapshot);
        known_truth = sampled ? sampled_truths(*this) : Truth{truth_of_scene(scene), {}, {}};
        known_truth->faults = std::exchange(faults, own);
    }
    return known_truth->layers;
}

const Layers& Trial::other_truth() {
    const Layers& first = truth();
    return known_truth->again ? *known_truth->again : first;
}

double mean_of(const Image<vec3>& image) {
    double sum = 0;
    for (const vec3 value : image.pixels) sum += (double(value.x) + value.y + value.z) / 3;
    return sum / static_cast<double>(image.pixels.size());
}

double max_of(const Image<vec3>& image) {
    float most = 0;
    for (const vec3 value : image.pixels) most = std::max(most, max_component(glm::abs(value)));
    return most;
}

double difference(const Image<vec3>& test, const Image<vec3>& reference) {
    const Errors errors = measure_errors(test, reference);
    return relative(errors.rmse, errors.mean_reference);
}

double difference(const Layers& test, const Layers& reference) {
    return std::max(difference(test.color, reference.color), difference(test.inscatter, reference.inscatter));
}

double error_to_truth(Trial& trial) {
    return is_noise(trial) ? bias_to_truth(trial) : difference(trial.render(), trial.truth());
}

double error_and_bias(Trial& trial) {
    if (is_noise(trial)) return std::max(bias_to_truth(trial, max_authored, false), trial.bias);
    StressScene preview = trial.scene;
    preview.view.pixel_samples = preview.settings.pixel.samples;
    const Layers &truth = trial.truth(), &other = trial.other_truth(), found = trial.render(preview);
    trial.bias = bias_of_means(found.inscatter, found.inscatter, truth.inscatter, other.inscatter);
    const double squares[] = {trial.bias * trial.bias,
                              bias_of(found.color, found.color, truth.color, other.color).squared,
                              bias_of(found.inscatter, found.inscatter, truth.inscatter, other.inscatter).squared};
    return std::sqrt(std::ranges::max(squares));
}

double error_of_mean(Trial& trial) {
    if (is_noise(trial)) return bias_of_mean(trial);
    return std::abs(mean_of(trial.render().inscatter) / mean_of(trial.truth().inscatter) - 1);
}

double stated_error(const Limitation& limitation) { return 1.5 * limitation.amounts[0] / 100 + 0.02; }

double leak(Trial& trial) {
    StressScene open = trial.scene;
    open.snapshot.occluders = nullptr, open.snapshot.scene = nullptr;
    return mean_of(trial.render().inscatter) / mean_of(trial.render(open).inscatter);
}

Camera camera_from(vec3 position, vec3 target, float vertical_fov) {
    return look_at(position, target, vec3(0, 1, 0), vertical_fov);
}

Camera flat_camera(vec3 position, vec3 target, float height) {
    Camera camera = look_at(position, target, vec3(0, 1, 0), 0.7f);
    camera.ortho_height = height;
    return camera;
}

StressScene stress_scene(std::vector<Medium> media, std::vector<Light> lights, Camera camera, std::vector<Mesh> meshes,
                         std::vector<Material> materials) {
    StressScene result;
    result.settings.path.orders = 1, result.settings.of<FroxelSettings>().tile = 1;
    result.view.camera = camera, result.view.size = stress_size;
    result.view.pixel_samples = 1, result.view.filter = PixelFilter::center;
    result.view.jitter = result.settings.pixel.jitter;
    result.scene = std::make_shared<Scene>();
    result.scene->materials = std::move(materials);
    for (Mesh& mesh : meshes) {
        result.scene->meshes.push_back(std::move(mesh));
        result.scene->instances.push_back({-1, static_cast<int>(result.scene->meshes.size()) - 1});
    }
    Box bounds;
    for (const Medium& medium : media)
        if (is_finite(medium.world_bounds.size())) bounds.grow(medium.world_bounds);
    for (const Light& light : lights) bounds.grow(light_bounds(light));
    result.snapshot = snapshot_of(std::move(media), std::move(lights));
    if (!bounds.empty()) result.snapshot.bounds = bounds;
    result.snapshot.scene = result.scene.get();
    if (!result.scene->meshes.empty()) add_surfaces(*result.scene, result.snapshot);
    return result;
}
}
