// Fog without surfaces: thin, thick, layered, thin sheets, several at once, and checks against closed forms.
#include "measure/stress/trial.h"
#include "modes/froxel/limitations.h"
#include "modes/shadow_map/limitations.h"
#include "modes/shadow_map/settings.h"
#include "modes/shared_limitations.h"
#include "scene/mesh.h"
#include "volume/bricks/sparse_volume.h"
#include "volume/phase.h"

#include "base/random.h"
#include "scene/light.h"
#include "volume/medium.h"

namespace tyndall {
namespace {
// The sun is at a slant, so that its light fades six times as fast as a step is deep: over 5 optical depths where the
// limitation states 0.9. One sample per step then has a relative error of sqrt(2.5 coth(2.5) - 1) = 1.2.
const std::vector<Excuse> thick{
    {&limitation::light_grid_cells, 1.2}, {&limitation::deep_steps, 1.2}, {&limitation::deep_froxels, 1.2}};
// Along the view, it fades over 2.5 optical depths in the deepest step: in its middle, light is
// 1.25 / sinh(1.25) = 0.78 of the mean.
const std::vector<Excuse> straight{
    {&limitation::light_grid_cells, 0.25}, {&limitation::deep_steps, 0.25}, {&limitation::deep_froxels, 0.25}};

const Light noon = sun_light({0.3f, -1, -0.2f}, 10);
const Camera front = camera_from({0, 0, 6}, vec3(0));

StressScene cube(double extinction, float half = 1) {
    return stress_scene({homogeneous_medium(static_cast<float>(extinction), {vec3(-half), vec3(half)})}, {noon}, front);
}
StressScene cube_of(double extinction) { return cube(extinction); }

// A wall behind fog; the eye in the fog, looking straight at it.
constexpr float wall_distance = 4;
StressScene wall(double depth) {
    const float extinction = static_cast<float>(depth) / wall_distance;
    StressScene scene =
        stress_scene({homogeneous_medium(extinction, {vec3(-9), vec3(9)})}, {noon},
                     flat_camera({0, 0, wall_distance}, vec3(0), 2), {box_of({-8, -8, -0.1f}, {8, 8, 0}, -1)});
    return scene;
}

double sky_off(Trial& trial) { return difference(trial.render().color, trial.truth().color); }

double transmittance_off(Trial& trial) {
    const Layers layers = trial.render();
    double most = 0;
    for (const float value : layers.transmittance.pixels)
        most = std::max(most, std::abs(value - std::exp(-trial.value)));
    return most;
}

// Fog between z = -3 and 3 that extends far to the sides, lit along the view: single backscattering.
StressScene slab(double depth) {
    const float extinction = static_cast<float>(depth) / 6;
    const Box box{vec3(-50, -50, -3), vec3(50, 50, 3)};
    return stress_scene({homogeneous_medium(extinction, box, {PhaseKind::isotropic, 0})}, {sun_light({0, 0, -1}, 10)},
                        flat_camera({0, 0, 5}, vec3(0), 2));
}

// Light that goes in and comes back the same way: ∫ exp(-2 t) dt over the depth, times lux / (4 pi).
double slab_off(Trial& trial) {
    const double expected = 10 / (4 * std::numbers::pi) * -std::expm1(-2 * trial.value) / 2;
    return std::abs(mean_of(trial.render().inscatter) / expected - 1);
}

StressScene sheet(double thickness) {
    const float half = 0.5f * static_cast<float>(thickness);
    return stress_scene({homogeneous_medium(0.05f / std::max(half, 1e-4f), {vec3(-2, -2, -half), vec3(2, 2, half)})},
                        {noon}, camera_from({1, 1, 5}, vec3(0)));
}

// Rays that run in a face of the box, and beside it.
StressScene in_the_face(double offset) {
    const float y = 1 + static_cast<float>(offset); // of the middle row
    return stress_scene({homogeneous_medium(0.3f, {vec3(-1), vec3(1)})}, {noon}, flat_camera({0, y, 5}, {0, y, 0}, 2));
}

StressScene eye_in_fog(double extinction) {
    return stress_scene({homogeneous_medium(static_cast<float>(extinction), {vec3(-3), vec3(3)})}, {noon},
                        camera_from({0.1f, 0.2f, 0.3f}, {0, 0, -1}));
}

StressScene endless(double extinction) {
    return stress_scene({homogeneous_medium(static_cast<float>(extinction), everywhere())},
                        {point_light({1, 1.5f, 1}, 10)}, front);
}

// The camera's far plane cuts the fog, which lies 5 to 7 m away.
StressScene cut_off(double far) {
    StressScene scene = cube(0.4);
    scene.view.camera.far = static_cast<float>(far);
    return scene;
}

StressScene layer(double falloff) {
    Medium fog = homogeneous_medium(0.3f, {vec3(-5, -1, -5), vec3(5, 3, 5)});
    fog.density.kind = DensityKind::height, fog.density.height_falloff = static_cast<float>(falloff);
    return stress_scene({fog}, {noon}, camera_from({0, 0.6f, 4}, {0, 0.1f, 0}));
}

StressScene glowing(double depth) {
    Medium fog = homogeneous_medium(static_cast<float>(depth) / 2, {vec3(-30, -30, -1), vec3(30, 30, 1)}, {}, vec3(0));
    fog.optics.emission.radiance = vec3(3);
    return stress_scene({fog}, {}, flat_camera({0, 0, 5}, vec3(0), 2));
}

double glow_off(Trial& trial) {
    const double expected = 6 / trial.value * -std::expm1(-trial.value);
    return std::abs(mean_of(trial.render().inscatter) / expected - 1);
}

StressScene copies(int count) {
    std::vector<Medium> media(static_cast<size_t>(count), homogeneous_medium(0.6f / static_cast<float>(count),
                                                                             {vec3(-1), vec3(1)}, forward_phase(0.4f)));
    for (Medium& medium : media) medium.name += std::to_string(&medium - media.data());
    return stress_scene(media, {noon}, front);
}
StressScene one_fog(double) { return copies(1); }

double copies_off(Trial& trial) {
    return difference(trial.render(copies(static_cast<int>(trial.value))), trial.render());
}

// Two clouds, one inside the other, of different color and phase function.
StressScene nested(double share) {
    Medium inner = homogeneous_medium(2, {vec3(-0.6f), vec3(0.6f)}, forward_phase(0.7f), vec3(0.9f, 0.4f, 0.2f));
    inner.world_bounds.low += vec3(static_cast<float>(share)), inner.density.bounds = inner.world_bounds;
    inner.world_bounds.high += vec3(static_cast<float>(share)), inner.density.bounds = inner.world_bounds;
    return stress_scene({homogeneous_medium(0.2f, {vec3(-1.5f), vec3(1.5f)}), inner}, {noon}, front);
}

StressScene white(double albedo) {
    const Box box{vec3(-1), vec3(1)};
    return stress_scene({homogeneous_medium(0.8f, box, forward_phase(0.3f), vec3(static_cast<float>(albedo)))}, {noon},
                        front);
}

StressScene bright_behind(double depth) {
    StressScene scene = cube(depth / 2);
    scene.snapshot.background.color = vec3(1e5f);
    return scene;
}

// Error of the mean over one period of the jitter's pattern.
double pattern_left(Trial& trial) {
    Image<vec3> sum(stress_size, vec3(0));
    StressScene scene = trial.scene;
    constexpr int frames = 16;
    for (int i = 0; i < frames; ++i) {
        scene.view.frame = i;
        const Layers layers = trial.render(scene);
        for (size_t p = 0; p < sum.pixels.size(); ++p) sum.pixels[p] += layers.inscatter.pixels[p] / float(frames);
    }
    Layers mean = trial.truth();
    mean.inscatter = mean.color = sum;
    return difference(mean, trial.truth());
}

StressScene jittered(double steps) {
    Light slit = spot_light({0, 2, 0}, {0, -1, 0}, 10, 0.25f, 0.26f);
    StressScene scene =
        stress_scene({homogeneous_medium(0.3f, {vec3(-2), vec3(2)})}, {slit}, camera_from({0, 0, 5}, vec3(0)));
    scene.settings.of<ShadowMapSettings>().steps = static_cast<int>(steps);
    scene.view.jitter = Jitter::spatiotemporal;
    return scene;
}
}

std::vector<StressCase> stress_fog() {
    constexpr std::string_view group = "fog and rays";
    return {
        StressCase{"thin-fog",
                   group,
                   "fog vanishes",
                   "extinction",
                   "1/m",
                   {1, 1e-2, 1e-4, 1e-8, 1e-12},
                   Claim::physical,
                   {},
                   cube_of},
        StressCase{"thick-fog",
                   group,
                   "fog becomes a wall",
                   "extinction",
                   "1/m",
                   {1, 3, 10, 100, 1000},
                   Claim::physical,
                   thick,
                   cube_of,
                   {0.1}},
        StressCase("transmittance", group, "the background fades by Beer-Lambert", "optical depth", "",
                   {0.01, 0.5, 2, 8, 32, 1000}, Claim::noise_free, {}, wall,
                   {1e-4, "largest error of the transmittance", transmittance_off}),
        StressCase("slab", group, "a slab's light in closed form", "optical depth", "", {0.01, 0.5, 2, 8, 30},
                   Claim::noise_free, straight, slab, {0.01, "error of the mean against the closed form", slab_off}),
        StressCase("thin-sheet", group, "a sheet of fog of constant depth gets thin", "thickness", "m",
                   {1, 0.1, 0.01, 0.001, 0}, Claim::physical, {}, sheet),
        StressCase("in-the-face", group, "rays run in the face of the fog's box", "ray to face", "m",
                   {0.1, -0.1, 1e-3, 1e-6, 0}, Claim::physical, {}, in_the_face),
        StressCase("eye-in-fog", group, "the camera is in thick fog", "extinction", "1/m", {0.1, 1, 4, 20},
                   Claim::physical, thick, eye_in_fog),
        StressCase("endless-fog", group, "fog without bounds", "extinction", "1/m", {0.5, 0.1, 0.01, 1e-3},
                   Claim::physical, {{&limitation::few_steps_for_glow}}, endless),
        StressCase("endless-thick-fog", group, "the same, thick", "extinction", "1/m", {1, 2},
                   Claim::noise_free | Claim::adaptive, {}, endless),
        StressCase("far-plane", group, "the far plane moves through the fog", "distance", "m",
                   {100, 6.9, 6, 5.1, 5.001}, Claim::physical, {}, cut_off),
        StressCase("ground-fog", group, "fog that clings to the ground", "falloff", "m", {10, 1, 0.3, 0.05, 0.005},
                   Claim::physical, {}, layer),
        StressCase("glowing-fog", group, "fog that emits and absorbs light", "optical depth", "", {0.1, 1, 5, 40},
                   Claim::noise_free, {}, glowing, {0.005, "error of the mean against the closed form", glow_off}),
        StressCase("copies", group, "one fog split into several in the same place", "copies", "", {2, 4, 8},
                   Claim::noise_free, {}, one_fog, {1e-3, "relative RMSE against one", copies_off}),
        StressCase("nested-fog", group, "fog of another color and phase inside fog", "offset", "m", {0, 0.7, 1.2, 3},
                   Claim::physical, {}, nested, {0.05}),
        StressCase("albedo", group, "fog from white to black", "albedo", "", {1, 0.5, 1e-3, 0}, Claim::physical, {},
                   white),
        StressCase("bright-behind", group, "a sky of 100 000 nits behind fog", "optical depth", "", {1, 4, 8, 12},
                   Claim::noise_free, {}, bright_behind, {0.002, "relative RMSE of the image", sky_off}),
        StressCase("pattern", group, "the jitter pattern averages out over 16 frames", "steps", "", {32, 16, 8},
                   "shadow-map", {}, jittered, {-1, to_truth, pattern_left}),
    };
}
}
