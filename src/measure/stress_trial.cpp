// Renders the tiny scenes of the stability suite, counts what is no light, and measures.
#include "measure/stress_trial.h"

#include "measure/halves.h"
#include "measure/metrics.h"
#include "render/candidates.h"

namespace tyndall {
namespace {
constexpr int noisy_samples = 16; // per pixel, of a mode whose error is noise

uint64_t negative_in(const Image<vec3>& image) {
    return static_cast<uint64_t>(std::ranges::count_if(
        image.pixels, [](vec3 value) { return std::min(value.x, std::min(value.y, value.z)) < 0; }));
}

// Values that no share of light can have.
uint64_t no_share_in(const Image<float>& image) {
    constexpr float rounding = 1e-5f;
    return static_cast<uint64_t>(
        std::ranges::count_if(image.pixels, [](float value) { return !(value >= 0 && value <= 1 + rounding); }));
}

uint64_t non_finite_in(const Image<vec3>& image) {
    return static_cast<uint64_t>(std::ranges::count_if(image.pixels, [](vec3 value) { return !is_finite(value); }));
}

void count_faults(const Layers& layers, const FrameStats& stats, Trial& trial) {
    trial.non_finite += stats.non_finite + non_finite_in(layers.color) + non_finite_in(layers.inscatter);
    trial.negative += negative_in(layers.color) + negative_in(layers.inscatter) + no_share_in(layers.alpha) +
                      no_share_in(layers.transmittance) + no_share_in(layers.validity);
    for (const auto& [name, light] : layers.lights)
        trial.non_finite += non_finite_in(light), trial.negative += negative_in(light);
}

// What of the difference between two independent pictures and the truth two standard errors do not explain.
double unexplained(const Image<vec3>& a, const Image<vec3>& b, const Image<vec3>& truth) {
    const Estimate squared = product_of_errors(a, b, truth, truth);
    const double rest = squared.value - 2 * squared.standard_error;
    return rest > 0 ? relative(std::sqrt(rest), mean_of(truth)) : 0;
}
}

Layers Trial::render(const StressScene& what, History* history) {
    View view = what.view;
    view.per_light = true;
    if (error_is_noise(*mode)) view.pixel_samples = noisy_samples;
    FrameOptions options;
    options.cancel = cancel, options.history = history;
    FrameStats stats;
    Layers layers = render_frame(*mode, view, what.snapshot, what.settings, options, stats);
    count_faults(layers, stats, *this);
    return layers;
}

Layers Trial::truth_of_scene(const StressScene& what) {
    Settings settings = truth_of(what.settings);
    View view = what.view;
    if (std::ranges::any_of(what.snapshot.lights, is_soft)) settings.march.light_points = 16, view.pixel_samples = 8;
    FrameOptions options;
    options.cancel = cancel;
    FrameStats stats;
    return render_frame(find_mode("march"), view, what.snapshot, settings, options, stats);
}

const Layers& Trial::truth() {
    if (!known_truth) known_truth = truth_of_scene(scene);
    return *known_truth;
}

double mean_of(const Image<vec3>& image) {
    double sum = 0;
    for (const vec3 value : image.pixels) sum += (double(value.x) + value.y + value.z) / 3;
    return sum / static_cast<double>(image.pixels.size());
}

double most_of(const Image<vec3>& image) {
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
    const Layers& truth = trial.truth();
    const Layers picture = trial.render();
    const bool noisy = error_is_noise(*trial.mode) || std::ranges::any_of(trial.scene.snapshot.lights, is_soft);
    if (!noisy) return difference(picture, truth);
    StressScene again = trial.scene;
    again.view.seed += 1;
    const Layers other = trial.render(again);
    if (difference(picture, other) == 0) return difference(picture, truth);
    return std::max(unexplained(picture.color, other.color, truth.color),
                    unexplained(picture.inscatter, other.inscatter, truth.inscatter));
}

double error_of_mean(Trial& trial) {
    if (error_is_noise(*trial.mode)) return error_to_truth(trial);
    return std::abs(mean_of(trial.render().inscatter) / mean_of(trial.truth().inscatter) - 1);
}

Light spot_light(vec3 position, vec3 direction, float candela, float inner, float outer) {
    Light light = point_light(position, candela);
    light.name = "spot", light.kind = LightKind::spot, light.direction = glm::normalize(direction);
    light.inner_cone = inner, light.outer_cone = outer;
    return light;
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
    result.settings.path.orders = 1, result.settings.froxel.tile = 1;
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
    for (const Light& light : lights)
        if (light.kind != LightKind::sun) bounds.grow(light.position);
    result.snapshot = snapshot_of(std::move(media), std::move(lights));
    if (!bounds.empty()) result.snapshot.bounds = bounds;
    result.snapshot.scene = result.scene.get();
    if (!result.scene->meshes.empty()) add_surfaces(*result.scene, result.snapshot);
    return result;
}
}
