// Artistic modes: radial blur and beam cards. They do not simulate light transport, but must behave well.
#include "measure/stress/trial.h"
#include "modes/billboard/limitations.h"
#include "modes/radial_blur/limitations.h"
#include "modes/radial_blur/settings.h"
#include "modes/resolution.h"
#include "scene/light.h"
#include "scene/mesh.h"
#include "scene/scene.h"
#include "volume/bricks/sparse_volume.h"
#include "volume/medium.h"
#include "volume/phase.h"

namespace tyndall {
namespace {
const Box cube{vec3(-8), vec3(8)};
// Radial blur need not be right about any light.
const std::vector<Excuse> no_light{{&limitation::screen_space, infinity}};
const std::vector<Excuse> faded{{&limitation::card_edge_on}, {&limitation::camera_in_card}};

StressScene blur_scene(Light light, Camera camera, std::vector<Mesh> meshes = {},
                       std::vector<Material> materials = {}) {
    StressScene scene =
        stress_scene({homogeneous_medium(0.05f, cube)}, {light}, camera, std::move(meshes), std::move(materials));
    scene.settings.of<RadialBlurSettings>().resolution = Resolution::full;
    return scene;
}
const Camera ahead = camera_from({0, 0, 6}, vec3(0));

// A sun `degrees` to the right of the view direction.
StressScene sun_aside(double degrees) {
    const float a = static_cast<float>(degrees) * pi / 180;
    return blur_scene(sun_light({-std::sin(a), 0, std::cos(a)}, 10), ahead,
                      {box_of({-1, -1, -1}, {-0.4f, 1, 1}, -1), box_of({0.4f, -1, -1}, {1, 1, 1}, -1)});
}
double light_added(Trial& trial) { return max_of(trial.render().inscatter); }

// How much brighter than with the sun one degree further in.
double grows_outside(Trial& trial) {
    const double now = mean_of(trial.render().inscatter);
    const double before = mean_of(trial.render(sun_aside(trial.value - 1)).inscatter);
    return before > 0 ? std::max(0.0, now / before - 1) : now;
}

// How much a turn of a quarter of a degree changes the image.
double pops(Trial& trial) {
    const double now = mean_of(trial.render().inscatter);
    const double next = mean_of(trial.render(sun_aside(trial.value + 0.25)).inscatter);
    const double middle = mean_of(trial.render(sun_aside(0)).inscatter);
    return std::abs(next - now) / middle;
}

// An emissive box beside the sun, in front of everything.
StressScene hot(float emission) {
    Material material;
    material.emission = vec3(emission);
    return blur_scene(sun_light({0.3f, 0, 1}, 10), ahead, {box_of({0.8f, -0.5f, 0}, {1.6f, 0.5f, 0.8f}, 0)},
                      {material});
}
StressScene hot_ball(double emission) { return hot(static_cast<float>(emission)); }
double smeared_emission(Trial& trial) {
    const Layers a = trial.render(), b = trial.render(hot(0));
    float most = 0;
    for (size_t i = 0; i < a.inscatter.pixels.size(); ++i)
        most = std::max(most, max_component(glm::abs(a.inscatter.pixels[i] - b.inscatter.pixels[i])));
    return most;
}

StressScene with_samples(double samples) {
    StressScene scene = sun_aside(5);
    scene.settings.of<RadialBlurSettings>().samples = static_cast<int>(samples);
    return scene;
}
double samples_off(Trial& trial) {
    return std::abs(mean_of(trial.render().inscatter) / mean_of(trial.render(with_samples(256)).inscatter) - 1);
}

// The disc of a lamp in the middle of the image, not smeared.
StressScene disc(double aspect) {
    StressScene scene = blur_scene(point_light(vec3(0), 10), ahead);
    scene.view.size = {static_cast<int>(96 * aspect), 96};
    scene.settings.of<RadialBlurSettings>().density = 0.01f, scene.settings.of<RadialBlurSettings>().lamp_size = 0.8f;
    return scene;
}
double eccentricity(Trial& trial) {
    const Layers layers = trial.render();
    double xx = 0, yy = 0;
    for (int y = 0; y < layers.size.y; ++y)
        for (int x = 0; x < layers.size.x; ++x) {
            const double value = layers.inscatter.at(x, y).x, dx = x + 0.5 - 0.5 * layers.size.x,
                         dy = y + 0.5 - 0.5 * layers.size.y;
            xx += value * dx * dx, yy += value * dy * dy;
        }
    return std::abs(std::sqrt(xx / yy) - 1);
}

StressScene in_thick_fog(double extinction) {
    StressScene scene = sun_aside(5);
    scene.snapshot.media[0].optics.extinction = vec3(static_cast<float>(extinction));
    return scene;
}

// --- beam cards --------------------------------------------------------------------------------------------------
// A wall at x = 0 with n x n holes, fog behind it, the sun at 45 degrees.
StressScene wall_with_holes(int n, Camera camera) {
    std::vector<Mesh> meshes{box_of({0, -0.1f, -4}, {6, 0, 4}, -1), box_of({0, 6, -4}, {6, 6.1f, 4}, -1)};
    const float cell = 3.0f / static_cast<float>(n), bar = 0.45f * cell;
    meshes.push_back(box_of({-0.05f, 0, -4}, {0, 1.5f, 4}, -1));
    meshes.push_back(box_of({-0.05f, 4.5f, -4}, {0, 6, 4}, -1));
    meshes.push_back(box_of({-0.05f, 1.5f, -4}, {0, 4.5f, -1.5f}, -1));
    meshes.push_back(box_of({-0.05f, 1.5f, 1.5f}, {0, 4.5f, 4}, -1));
    for (int i = 0; i <= n; ++i) {
        const float at = cell * static_cast<float>(i) - 0.5f * bar;
        meshes.push_back(box_of({-0.05f, 1.5f + at, -1.5f}, {0, 1.5f + at + bar, 1.5f}, -1));
        meshes.push_back(box_of({-0.05f, 1.5f, -1.5f + at}, {0, 4.5f, -1.5f + at + bar}, -1));
    }
    const Box fog{vec3(0, 0, -4), vec3(6, 6, 4)};
    return stress_scene({homogeneous_medium(0.1f, fog)}, {sun_light({1, -1, 0}, 10)}, camera, meshes);
}

Camera around_beam(double degrees) {
    const float a = static_cast<float>(degrees) * pi / 180;
    return camera_from(vec3(1.7f, 2, 0) + 3.5f * vec3(std::sin(a), 0.3f, std::cos(a)), {1.7f, 2, 0});
}
StressScene orbit(double degrees) { return wall_with_holes(1, around_beam(degrees)); }
double orbit_pops(Trial& trial) {
    const double now = mean_of(trial.render().inscatter);
    const double next = mean_of(trial.render(orbit(trial.value + 0.5)).inscatter);
    return std::abs(next - now) / std::max(now, next);
}

StressScene holes(double n) { return wall_with_holes(static_cast<int>(n), around_beam(0)); }
double energy(Trial& trial) { return mean_of(trial.render().inscatter) / mean_of(trial.truth().inscatter); }

// The eye enters the beam from the side.
StressScene into_beam(double distance) {
    const float d = static_cast<float>(distance);
    return wall_with_holes(1, camera_from({1.5f, 1.5f, d}, {1.5f, 1.4f, -4}));
}
double much_brighter(Trial& trial) {
    return max_of(trial.render().inscatter) / max_of(trial.render(into_beam(4)).inscatter);
}

// A table top rises into the beam: cards fade out before it instead of being cut.
StressScene table(double height) {
    StressScene scene = wall_with_holes(1, around_beam(20));
    const float y = static_cast<float>(height);
    scene.scene->meshes.push_back(box_of({0.2f, y - 0.1f, -2}, {4, y, 2}, -1));
    scene.scene->instances.push_back({-1, static_cast<int>(scene.scene->meshes.size()) - 1});
    add_surfaces(*scene.scene, scene.snapshot);
    return scene;
}
double table_pops(Trial& trial) {
    const double now = mean_of(trial.render().inscatter);
    const double next = mean_of(trial.render(table(trial.value + 0.01)).inscatter);
    return std::abs(next - now) / mean_of(trial.render(orbit(20)).inscatter);
}
}

std::vector<StressCase> stress_looks() {
    constexpr std::string_view group = "artistic modes";
    return {
        StressCase("sun-behind", group, "no ghost of a sun behind the camera", "sun to view", "degrees",
                   {90, 91, 135, 180}, "radial-blur", {}, sun_aside, {0, "brightest pixel added", light_added}),
        StressCase("sun-leaves", group, "rays fade out as the sun leaves the image", "sun to view", "degrees",
                   {40, 50, 60, 70, 80, 88}, "radial-blur", {}, sun_aside,
                   {0.01, "gain over one degree further in", grows_outside}),
        StressCase("sun-crosses-edge", group, "rays do not pop where the sun crosses the edge", "sun to view",
                   "degrees", {20, 28, 32, 34, 50}, "radial-blur", {}, sun_aside,
                   {0.03, "change over a quarter of a degree / maximum", pops}),
        StressCase("hot-foreground", group, "bright objects other than the sun are not smeared", "emission", "nits",
                   {1, 100, 1e4}, "radial-blur", {}, hot_ball,
                   {1e-3, "largest change of what is added", smeared_emission}),
        StressCase("blur-samples", group, "brightness does not depend on the number of samples", "samples", "",
                   {128, 64, 32}, "radial-blur", {}, with_samples,
                   {0.01, "change of the mean against 256", samples_off}),
        StressCase("round-disc", group, "the disc of a lamp is round in any image", "width to height", "",
                   {1, 1.78, 2.4, 0.5}, "radial-blur", {}, disc, {0.01, "eccentricity", eccentricity}),
        StressCase("smear-is-no-light", group, "fog gets thick around smeared rays", "extinction", "1/m",
                   {0.01, 0.1, 1}, "radial-blur", no_light, in_thick_fog),
        StressCase("round-a-beam", group, "the camera goes around a beam: its card does not pop", "azimuth", "degrees",
                   {0, 30, 60, 85, 90, 120, 180}, "billboard", faded, orbit,
                   {0.02, "change of the mean over half a degree", orbit_pops}),
        StressCase("many-cards", group, "overlapping cards do not add more light than there is", "openings", "per side",
                   {1, 2, 4, 8}, "billboard", {}, holes, {1, "mean / that of the exact march", energy}),
        StressCase("into-a-card", group, "the camera enters a beam: its card does not fill the image", "camera to beam",
                   "m", {2, 1, 0.5, 0.1, 0}, "billboard", {}, into_beam,
                   {1.5, "brightest pixel / that seen from afar", much_brighter}),
        StressCase("card-meets-table", group, "a table top rises into a beam: its card has no hard cut", "height", "m",
                   {0.5, 1, 1.5, 2}, "billboard", {}, table,
                   {0.02, "change over a centimeter / mean without it", table_pops}),
    };
}
}
