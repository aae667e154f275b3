// How fog scatters light: lobes, signs, colors, layers.
#include "measure/stress/trial.h"
#include "scene/light.h"
#include "scene/mesh.h"
#include "volume/bricks/sparse_volume.h"
#include "volume/medium.h"
#include "volume/phase.h"

namespace tyndall {
namespace {

const Box unit{vec3(-1), vec3(1)};
const Light noon = sun_light({0.3f, -1, -0.2f}, 10);

// The middle of the image looks 3 degrees past the sun.
StressScene towards_sun(double g) {
    const Medium fog = homogeneous_medium(0.4f, unit, forward_phase(static_cast<float>(g)));
    return stress_scene({fog}, {sun_light({0.05f, 0, 1}, 10)}, camera_from({0, 0, 4}, vec3(0)));
}

// Optically thin fog, so that its attenuation is the same seen along the sun's direction and against it.
StressScene narrow(double g, float z) {
    const Medium fog = homogeneous_medium(0.01f, unit, forward_phase(static_cast<float>(g)));
    StressScene scene = stress_scene({fog}, {sun_light({0, 0, 1}, 10)}, camera_from({0, 0, z}, vec3(0), 1e-3f));
    scene.view.size = {8, 8};
    return scene;
}
StressScene towards_sun_in_droplets(double diameter) {
    const Medium fog = homogeneous_medium(0.4f, unit, mie_phase(diameter));
    return stress_scene({fog}, {sun_light({0.05f, 0, 1}, 10)}, camera_from({0, 0, 4}, vec3(0)));
}

StressScene into_sun(double g) { return narrow(g, 4); }

// The view towards the sun is ((1 + g) / (1 - g))^3 times as bright as the view away from it.
double ratio_off(Trial& trial) {
    const double g = trial.value;
    const double into = mean_of(trial.render().inscatter), away = mean_of(trial.render(narrow(g, -4)).inscatter);
    return std::abs(into / away / std::pow((1 + g) / (1 - g), 3) - 1);
}

StressScene kinds(double kind) {
    PhaseTableNotes notes;
    const std::vector<PhaseEntry> bow{{0, 9}, {20, 2}, {90, 0.3}, {135, 0.2}, {138, 0.6}, {143, 0.3}, {180, 0.4}};
    const Phase phases[] = {
        {PhaseKind::isotropic, 0},
        {PhaseKind::rayleigh, 0},
        {PhaseKind::schlick, 0.5f},
        {PhaseKind::schlick, -0.5f},
        {PhaseKind::henyey_greenstein, 1e-4f},
        draine_phase(0.6, 3),
        mie_phase(20),
        mixed_phase(0.6, {PhaseKind::henyey_greenstein, 0.8f}, {PhaseKind::henyey_greenstein, -0.7f}),
        table_phase(PhaseKind::table, make_table(std::span(bow), notes))};
    return stress_scene({homogeneous_medium(0.4f, unit, phases[static_cast<int>(kind)])}, {noon},
                        camera_from({0, 0, 4}, vec3(0)));
}

StressScene in_even_light(double depth) {
    const Medium fog =
        homogeneous_medium(static_cast<float>(depth) / 2, {vec3(-30, -30, -1), vec3(30, 30, 1)}, {}, vec3(0.8f));
    StressScene scene = stress_scene({fog}, {}, flat_camera({0, 0, 5}, vec3(0), 2));
    scene.snapshot.ambient = vec3(2);
    return scene;
}

// Unshadowed: albedo · ambient · (1 - T).
double even_light_off(Trial& trial) {
    return std::abs(mean_of(trial.render().inscatter) / (0.8 * 2 * -std::expm1(-trial.value)) - 1);
}

StressScene dim_or_bright(double) {
    return stress_scene({homogeneous_medium(0.4f, unit, forward_phase(0.3f))}, {noon}, camera_from({0, 0, 4}, vec3(0)));
}

// Light is linear: the image of a sun scaled by a factor, divided by that factor.
double not_linear(Trial& trial) {
    const float factor = static_cast<float>(trial.value);
    StressScene other = trial.scene;
    for (Light& light : other.snapshot.lights) light.intensity *= factor;
    Layers layers = trial.render(other);
    for (Image<vec3>* image : {&layers.color, &layers.inscatter})
        for (vec3& pixel : image->pixels) pixel /= factor;
    return difference(layers, trial.render());
}

StressScene two_colors(double) {
    Light blue = spot_light({0, 1.5f, 0}, {0.2f, -1, 0}, 5, 0.4f, 0.6f);
    blue.intensity = vec3(0.2f, 0.5f, 5), blue.radius = 0.05f;
    return stress_scene({homogeneous_medium(0.4f, unit, forward_phase(0.5f), vec3(0.9f, 0.6f, 0.3f))}, {noon, blue},
                        camera_from({0, 0, 4}, vec3(0)));
}

// The layers of the lights must add up to the fog light that is rendered without layers.
double sum_off(Trial& trial) {
    const Layers layers = trial.render();
    Layers sum = trial.render(trial.scene, nullptr, true);
    sum.inscatter = Image<vec3>(layers.size, vec3(0));
    for (const auto& [name, light] : sum.lights)
        for (size_t i = 0; i < light.pixels.size(); ++i) sum.inscatter.pixels[i] += light.pixels[i];
    return difference(sum, layers);
}
}

std::vector<StressCase> stress_scattering() {
    constexpr std::string_view group = "scattering";
    return {
        StressCase("forward-lobe", group, "looking past the sun through a lobe that gets narrow", "g", "",
                   {0, 0.5, 0.8, 0.95, 0.99}, Claim::physical, {}, towards_sun,
                   {0.05, "error of the mean", error_of_mean}),
        StressCase("backward-lobe", group, "the same for a backward lobe", "g", "", {-0.3, -0.8, -0.99},
                   Claim::physical, {}, towards_sun),
        StressCase("phase-sign", group, "fog of positive g is bright around the sun", "g", "", {0.2, 0.5, 0.8},
                   Claim::physical, {}, into_sun,
                   {0.01, "error of the ratio of bright to dark side, ((1+g)/(1-g))^3", ratio_off}),
        StressCase("phase-kinds", group, "phase functions of every kind", "kind", "", {0, 1, 2, 3, 4, 5, 6, 7, 8},
                   Claim::physical, {}, kinds),
        StressCase("droplets", group, "looking past the sun through droplets of growing size", "diameter",
                   "micrometers", {5, 10, 20, 50}, Claim::physical, {}, towards_sun_in_droplets,
                   {0.05, "error of the mean", error_of_mean}),
        StressCase("even-light", group, "fog in uniform light from all directions", "optical depth", "", {0.1, 1, 8},
                   Claim::noise_free, {}, in_even_light,
                   {0.005, "error of the mean against the closed form", even_light_off}),
        StressCase("linear", group, "twice the light is twice the image", "sun", "times", {2, 1e-6, 1e6, 1e12},
                   Claim::noise_free, {}, dim_or_bright,
                   {1e-4, "relative RMSE of the image / strength of the light", not_linear}),
        StressCase("light-layers", group, "the lights' layers add up", "frame", "", {0}, Claim::all, {}, two_colors,
                   {1e-5, "relative RMSE of the sum", sum_off}),
    };
}
}
