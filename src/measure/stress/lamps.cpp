// Local lights in homogeneous fog, with nothing in their way: the geometry of cones, and the singularity at the lamp.
#include "measure/stress/trial.h"
#include "modes/cone/settings.h"
#include "modes/froxel/limitations.h"
#include "modes/shadow_map/limitations.h"
#include "modes/shared_limitations.h"
#include "scene/light.h"
#include "scene/mesh.h"
#include "volume/bricks/sparse_volume.h"
#include "volume/medium.h"
#include "volume/phase.h"

namespace tyndall {
namespace {
// One sample per step: where light fills a fifth of the step, the relative error is sqrt(1 / 0.2 - 1) = 2.
const std::vector<Excuse> glow{{&limitation::few_steps_for_glow, 2},
                               {&limitation::light_grid_cells},
                               {&limitation::deep_steps},
                               {&limitation::deep_froxels}};
constexpr float degree = pi / 180;

Medium haze(float extinction = 0.2f) { return homogeneous_medium(extinction, {vec3(-6), vec3(6)}); }

StressScene spot_scene(Light light, Camera camera) { return stress_scene({haze()}, {light}, camera); }

// A spot that shines down from (0, 2, 0), seen from the side.
Light lamp(float inner, float outer) { return spot_light({0, 2, 0}, {0, -1, 0}, 10, inner, outer); }
const Camera beside = camera_from({0, 0.5f, 5}, {0, 0.5f, 0});

StressScene eye_in_cone(double x) {
    return spot_scene(lamp(0.3f, 0.5f), camera_from({static_cast<float>(x), -1.5f, 0.3f}, {0, -1.7f, -4}));
}

StressScene eye_in_apex(double distance) {
    const float d = static_cast<float>(distance);
    return spot_scene(lamp(0.3f, 0.5f), camera_from({0, 2 - 0.2f * d, d}, {0, 1 - 0.2f * d, -4}));
}

// The middle ray goes through the lamp, whose radius bounds the light scattered along this ray.
StressScene down_the_axis(double angle) {
    const float a = static_cast<float>(angle) * degree;
    const vec3 eye = vec3(0, 2, 0) + 3.0f * vec3(std::sin(a), std::cos(a), 0);
    Light light = lamp(0.3f, 0.5f);
    light.radius = 0.02f, light.shadows = false;
    return spot_scene(light, camera_from(eye, {0, -1, 0}));
}

StressScene near_lamp(double offset) {
    Camera camera = camera_from({static_cast<float>(offset), 0, 5}, {static_cast<float>(offset), 0, 0}, 0.1f);
    Light light = point_light(vec3(0), 10);
    light.radius = 0.02f, light.shadows = false;
    return spot_scene(light, camera);
}

StressScene near_point(double offset) {
    StressScene scene = near_lamp(offset);
    scene.snapshot.lights[0].radius = 0;
    return scene;
}

double step_at_lamp(Trial& trial) {
    StressScene other = trial.scene;
    other.view.camera.position.x *= 2;
    const double near = mean_of(trial.render().inscatter), far = mean_of(trial.render(other).inscatter);
    return std::abs(far / near - 1);
}

// Camera rays run along the edge of the cone at this angle to it.
StressScene along_edge(double angle) {
    const float half = 0.35f, turn = half + static_cast<float>(angle) * degree;
    const vec3 along(std::sin(turn), -std::cos(turn), 0);
    const vec3 edge = vec3(0, 2, 0) + 2.0f * vec3(std::sin(half), -std::cos(half), 0);
    return spot_scene(lamp(0.2f, half), camera_from(edge - 5.0f * along + vec3(0, 0, 0.02f), edge, 0.02f));
}

StressScene behind_apex(double half_angle) {
    const float a = static_cast<float>(half_angle) * degree;
    return spot_scene(lamp(0.5f * a, a), flat_camera({0, 4.2f, 5}, {0, 4.2f, 0}, 2));
}

double light_there(Trial& trial) { return max_of(trial.render().inscatter); }

StressScene wide(double half_angle) {
    const float a = static_cast<float>(half_angle) * degree;
    return spot_scene(lamp(0.8f * a, a), beside);
}

StressScene hard_edge(double ratio) { return spot_scene(lamp(static_cast<float>(ratio) * 0.4f, 0.4f), beside); }

StressScene clipped(double radius) {
    StressScene scene = hard_edge(0.7);
    scene.settings.of<ConeSettings>().near_radius = static_cast<float>(radius);
    return scene;
}

// The most that a pixel is brighter than without the clip, relative to the mean.
double brighter_than_whole(Trial& trial) {
    StressScene whole = trial.scene;
    whole.settings.of<ConeSettings>().near_radius = 0;
    const Layers a = trial.render(), b = trial.render(whole);
    float most = 0;
    for (size_t i = 0; i < a.inscatter.pixels.size(); ++i)
        most = std::max(most, a.inscatter.pixels[i].x - b.inscatter.pixels[i].x);
    return most / mean_of(b.inscatter);
}

StressScene short_range(double range) {
    Light light = lamp(0.3f, 0.5f);
    light.range = static_cast<float>(range);
    return spot_scene(light, beside);
}

StressScene many(double count) {
    std::vector<Light> lights;
    for (int i = 0; i < static_cast<int>(count); ++i) {
        const float x = -2 + 4 * (static_cast<float>(i) + 0.5f) / static_cast<float>(count);
        lights.push_back(spot_light({x, 2, 0}, {-0.3f * x, -1, 0.2f * x}, 3, 0.15f, 0.25f));
        lights.back().name += std::to_string(i);
    }
    return stress_scene({haze()}, lights, beside);
}

StressScene moving_lamp(double share) {
    // Pixels are as wide as froxels.
    const float pixel = 2 * 5 * std::tan(0.35f) / static_cast<float>(stress_size.y);
    return spot_scene(point_light({0.7f + static_cast<float>(share) * pixel, 0.4f, 0}, 10), beside);
}

StressScene lamp_in_thick_fog(double extinction) {
    Light light = point_light({0.33f, 0.21f, 0}, 10);
    light.radius = 0.02f, light.shadows = false;
    return stress_scene({haze(static_cast<float>(extinction))}, {light}, camera_from({0, 0, 2.5f}, vec3(0)));
}
}

std::vector<StressCase> stress_lamps() {
    constexpr std::string_view group = "lamps in homogeneous fog";
    return {
        StressCase("eye-in-cone", group, "the camera enters a spot's cone", "camera to axis", "m", {4, 2, 1, 0.5, 0},
                   Claim::physical, glow, eye_in_cone),
        StressCase("eye-at-apex", group, "the camera comes near a spot", "camera to lamp", "m",
                   {3, 1, 0.3, 0.05, 0.001}, Claim::physical, glow, eye_in_apex),
        StressCase("down-the-axis", group, "the view turns to run along a spot's axis", "view to axis", "degrees",
                   {90, 30, 10, 1, 0}, Claim::lamps, glow, down_the_axis),
        StressCase("near-lamp", group, "rays pass a small lamp closer and closer", "middle ray to lamp", "m",
                   {0.3, 0.1, 0.01, 0}, Claim::lamps, glow, near_lamp),
        StressCase("near-point", group, "the same for a lamp without size", "middle ray to lamp", "m",
                   {0.3, 0.1, 0.01, 1e-3}, Claim::lamps, glow, near_point),
        // Froxels average a lamp's light within each, so that only the mean over the image is right.
        StressCase("lamp-in-froxel", group, "the mean light of a lamp within a froxel", "middle ray to lamp", "m",
                   {0.3, 0.1, 0.01, 0}, "froxel", {}, near_lamp, {0.05, "error of the mean", error_of_mean}),
        StressCase("through-lamp", group, "no step where a ray meets the lamp itself", "middle ray to lamp", "m",
                   {1e-3, 1e-4, 1e-6}, Claim::physical, {}, near_lamp,
                   {0.01, "change of the mean when the offset is doubled", step_at_lamp}),
        StressCase("along-edge", group, "rays become parallel to a cone's edge", "ray to edge", "degrees",
                   {20, 5, 1, 0.01, 0}, Claim::physical, glow, along_edge),
        StressCase("mirror-cone", group, "no light behind a spot, where its cone continues mathematically",
                   "half angle", "degrees", {5, 20, 45, 70}, Claim::physical, {}, behind_apex,
                   {0, "brightest pixel", light_there}),
        StressCase("wide-cone", group, "very narrow cones, right angles and cones without width", "half angle",
                   "degrees", {60, 85, 90, 20, 5, 1, 0}, Claim::physical, glow, wide),
        StressCase("hard-edge", group, "the soft edge of a cone gets hard", "inner to outer angle", "",
                   {0, 0.5, 0.9, 0.999, 1}, Claim::physical, glow, hard_edge),
        StressCase("lens", group, "a lens that cuts a cone adds no light", "lens radius", "m", {0.05, 0.2, 0.5, 1.5},
                   "cone", {}, clipped, {1e-5, "largest gain of a pixel / mean", brighter_than_whole}),
        StressCase("short-range", group, "the range of a lamp gets short", "range", "m", {100, 5, 2, 0.5, 0.1},
                   Claim::physical, glow, short_range),
        StressCase("many-lamps", group, "many spots at once", "spots", "", {1, 4, 16, 48}, Claim::physical, glow, many),
        StressCase("lamp-between-cells", group, "a lamp moves through one pixel", "distance", "pixels",
                   {0, 0.25, 0.5, 0.75, 1}, Claim::physical, glow, moving_lamp,
                   {0.05, "error of the mean", error_of_mean}),
        StressCase("lamp-in-thick-fog", group, "a small lamp in fog that gets thick", "extinction", "1/m",
                   {0.1, 1, 5, 20}, Claim::noise_free, glow, lamp_in_thick_fog),
        StressCase("traced-lamp", group, "the same, as thick as light paths can handle", "extinction", "1/m",
                   {0.1, 1, 2}, "path", {}, lamp_in_thick_fog),
    };
}
}
