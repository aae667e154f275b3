// Temporal reuse: lights that move, dim and go out, cuts, a bad frame; and the froxels that hold this light.
#include "measure/stress/trial.h"
#include "modes/froxel/limitations.h"
#include "modes/shared_limitations.h"
#include "scene/mesh.h"
#include "scene/scene.h"
#include "volume/bricks/sparse_volume.h"
#include "volume/phase.h"

#include "modes/fog_buffer.h"
#include "modes/history.h"
#include "modes/history_limitations.h"
#include "scene/light.h"
#include "scene/lights/gobo.h"
#include "volume/medium.h"

#include <utility>

namespace tyndall {
namespace {
constexpr int long_enough = 8; // frames until a history has settled
// Over eight frames the beam moves by nearly its width: half of the history's light is elsewhere.
const std::vector<Excuse> trail_of_froxels{{&limitation::moving_light, 0.5}};
const std::vector<Excuse> trail_of_shadows{{&limitation::moving_shadows, 0.5}};
const std::vector<Excuse> trail_of_fog{{&limitation::moving_fog, 0.7}};
const std::vector<Excuse> blur_of_froxels{{&limitation::moving_camera, 0.1}};
// The eye moves by 0.2 optical depths, and light is constant within a froxel: it may jump by as much.
const std::vector<Excuse> blurred{
    {&limitation::light_grid_cells, 0.22}, {&limitation::deep_steps, 0.22}, {&limitation::deep_froxels, 0.22}};
const std::vector<Excuse> unseen{{&limitation::coarse_shafts}, shadows_ignored};

Medium dust(float extinction = 0.3f) {
    return homogeneous_medium(extinction, {vec3(-3), vec3(3)}, forward_phase(0.3f));
}
const Light slanting = sun_light({0.5f, -1, 0.1f}, 10);

std::vector<Mesh> roof() {
    return {box_of({-9, 2, -9}, {-0.5f, 2.1f, 9}, -1), box_of({0.5f, 2, -9}, {9, 2.1f, 9}, -1)};
}

StressScene spot_and_sun(Light spot, Camera camera = camera_from({0, 0, 6}, vec3(0))) {
    return stress_scene({dust()}, {slanting, spot}, camera, roof());
}
Light spot_at(float x) {
    Light spot = spot_light({x, 1.8f, 0}, {0, -1, 0}, 20, 0.25f, 0.35f);
    spot.radius = 0.05f;
    return spot;
}
StressScene lit(double) { return spot_and_sun(spot_at(0.3f)); }

// The same, with keyframes for the spot's position in the scene.
StressScene lit_by_moving(double) {
    StressScene scene = lit(0);
    LightSource source;
    source.name = scene.snapshot.lights[1].name;
    source.position.times = {0, 1}, source.position.values = {vec3(-1, 1.8f, 0), vec3(1, 1.8f, 0)};
    scene.scene->lights = {source};
    return scene;
}

// Renders a frame of a shot: jitter advances, surfaces stay those of `first`.
Layers next_frame(Trial& trial, StressScene scene, const StressScene& first, int frame, History& history) {
    scene.scene = first.scene, scene.snapshot.scene = first.scene.get();
    scene.snapshot.occluders = first.snapshot.occluders;
    scene.snapshot.frame = scene.view.frame = frame;
    return trial.render(scene, &history);
}

void settle(Trial& trial, const StressScene& scene, History& history) {
    for (int frame = 0; frame < long_enough; ++frame) next_frame(trial, scene, scene, frame, history);
}

// A light changes to `factor` of its intensity: the share of its light that is missing or left after `frames` frames.
double off_after(Trial& trial, float factor, int frames) {
    History history;
    settle(trial, trial.scene, history);
    StressScene dimmed = trial.scene;
    dimmed.snapshot.lights[1].intensity *= factor;
    if (factor == 0) dimmed.snapshot.lights.pop_back();
    Layers last;
    for (int i = 0; i < frames; ++i) last = next_frame(trial, dimmed, trial.scene, long_enough + i, history);
    StressScene dark = trial.scene;
    dark.snapshot.lights.pop_back();
    const double whole = mean_of(trial.render().inscatter) - mean_of(trial.render(dark).inscatter);
    return std::abs(mean_of(last.inscatter) - mean_of(trial.render(dimmed).inscatter)) / whole;
}
double left_when_out(Trial& trial) { return off_after(trial, 0, static_cast<int>(trial.value)); }
double left_when_dimmed(Trial& trial) { return off_after(trial, static_cast<float>(trial.value), 4); }

// A spot that projects film: its gobo's image changes in every frame.
StressScene film(int squares) {
    Light spot = spot_at(0.3f);
    spot.radius = 0;
    return spot_and_sun(filtered_light(spot, nullptr, board_gobo(squares, 8, vec3(1), vec3(0))));
}
StressScene first_image(double) { return film(2); }

// The share of the change to the image of `next` that is missing after trial.value frames; noise averages out.
double left_of_change(Trial& trial, StressScene next) {
    History history;
    settle(trial, trial.scene, history);
    const std::shared_ptr<Scene> surfaces =
        std::exchange(next.scene, trial.scene.scene); // a history belongs to one scene
    next.snapshot.scene = next.scene.get();
    Layers last;
    for (int i = 0; i < static_cast<int>(trial.value); ++i) {
        next.snapshot.frame = next.view.frame = long_enough + i;
        last = trial.render(next, &history);
    }
    next.snapshot.frame = next.view.frame = trial.scene.view.frame;
    const Layers first = trial.render(), whole = trial.render(next);
    double left = 0, change = 0;
    for (size_t i = 0; i < whole.inscatter.pixels.size(); ++i) {
        const dvec3 way = dvec3(first.inscatter.pixels[i]) - dvec3(whole.inscatter.pixels[i]);
        left += glm::dot(dvec3(last.inscatter.pixels[i]) - dvec3(whole.inscatter.pixels[i]), way);
        change += glm::dot(way, way);
    }
    return std::abs(left / change);
}
double left_of_image(Trial& trial) { return left_of_change(trial, film(3)); }

// A door in the roof, with keyframes for its position.
StressScene behind_door(float x) {
    std::vector<Mesh> meshes = roof();
    meshes.push_back(box_of({x, 1.9f, -9}, {x + 0.6f, 1.95f, 9}, -1));
    StressScene scene = stress_scene({dust()}, {slanting}, camera_from({0, 0, 6}, vec3(0)), meshes);
    Node door;
    door.translation.times = {0, 1}, door.translation.values = {vec3(0), vec3(0.4f, 0, 0)};
    scene.scene->nodes = {door};
    scene.scene->instances.back().node = 0;
    return scene;
}
StressScene open_door(double) { return behind_door(-0.9f); }
double left_of_shadow(Trial& trial) { return left_of_change(trial, behind_door(-0.5f)); }

// A puff that drifts by half its size, with keyframes for its position.
StressScene puff_at(float x) {
    Medium puff = homogeneous_medium(2, {vec3(x - 0.4f, -0.4f, -0.4f), vec3(x + 0.4f, 0.4f, 0.4f)});
    puff.name = "puff";
    StressScene scene = stress_scene({dust(0.05f), puff}, {slanting}, camera_from({0, 0, 6}, vec3(0)));
    MediumSource source;
    source.name = puff.name;
    source.translation.times = {0, 1}, source.translation.values = {vec3(0), vec3(0.4f, 0, 0)};
    scene.scene->media = {source};
    return scene;
}
StressScene drifting_puff(double) { return puff_at(-0.2f); }
double left_of_puff(Trial& trial) { return left_of_change(trial, puff_at(0.2f)); }

// A spot that moves by trial.value per frame: the error with a history less that without.
double trail(Trial& trial) {
    History history;
    const float step = static_cast<float>(trial.value);
    Layers last;
    StressScene scene;
    for (int i = 0; i < long_enough; ++i) {
        scene = spot_and_sun(spot_at(-1 + step * static_cast<float>(i)));
        last = next_frame(trial, scene, trial.scene, i, history);
    }
    const Layers truth = trial.truth_of_scene(scene);
    return difference(last, truth) - difference(trial.render(scene), truth);
}

// The eye moves past a pillar close to it: what is uncovered must not lag.
StressScene behind_pillar(float x) {
    std::vector<Mesh> meshes = roof();
    meshes.push_back(box_of({-0.2f, -3, 3.5f}, {0.2f, 2, 3.8f}, -1));
    return stress_scene({dust()}, {slanting}, camera_from({x, 0, 6}, {x, 0, 0}), meshes);
}
// With keyframes for the eye's position.
StressScene pillar(double) {
    StressScene scene = behind_pillar(-1);
    CameraSource source;
    source.name = scene.view.camera.name;
    source.position.times = {0, 1}, source.position.values = {vec3(-1, 0, 6), vec3(1, 0, 6)};
    scene.scene->cameras = {source};
    return scene;
}
double uncovered(Trial& trial) {
    History history;
    Layers last;
    StressScene scene;
    for (int i = 0; i < long_enough; ++i) {
        scene = behind_pillar(-1 + static_cast<float>(trial.value) * static_cast<float>(i));
        last = next_frame(trial, scene, trial.scene, i, history);
    }
    const Layers truth = trial.truth_of_scene(scene);
    return difference(last, truth) - difference(trial.render(scene), truth);
}

enum class Cut { camera, lens, size, scene };
double after_cut(Trial& trial) {
    History history;
    settle(trial, trial.scene, history);
    StressScene other = trial.scene;
    switch (static_cast<Cut>(static_cast<int>(trial.value))) {
    case Cut::camera:
        other.view.camera = camera_from({5, 0.5f, 3}, vec3(0));
        break;
    case Cut::lens:
        other.view.camera.vertical_fov = 0.4f;
        break;
    case Cut::size:
        other.view.size = {32, 20};
        break;
    case Cut::scene:
        other = spot_and_sun(spot_at(-1));
        break;
    }
    other.snapshot.frame = other.view.frame = long_enough;
    History none;
    const Layers picture = trial.render(other, &history);
    return difference(picture, trial.render(other, &none));
}

// A frame whose fog light is NaN or infinite: the next must show nothing of it.
double after_bad_frame(Trial& trial) {
    History history;
    settle(trial, trial.scene, history);
    const uint64_t before = trial.faults.non_finite;
    StressScene bad = trial.scene;
    bad.snapshot.media[0].optics.emission.radiance = vec3(static_cast<float>(trial.value));
    next_frame(trial, bad, trial.scene, long_enough, history);
    trial.faults.non_finite = before; // the bad frame itself does not count
    const Layers next = next_frame(trial, trial.scene, trial.scene, long_enough + 1, history);
    return difference(next, trial.truth());
}

double with_history(Trial& trial) {
    History history;
    settle(trial, trial.scene, history);
    return difference(next_frame(trial, trial.scene, trial.scene, long_enough, history), trial.truth());
}

StressScene deep(double depth) {
    const float d = static_cast<float>(depth);
    return stress_scene({homogeneous_medium(1 / d, {vec3(-2 * d, -3, -d), vec3(2 * d, 3, 0)})}, {slanting},
                        camera_from({0, 0, 1}, {0, 0, -1}));
}

StressScene near_wall(double distance) {
    const float z = 3 - static_cast<float>(distance);
    return stress_scene({dust()}, {sun_light({0.3f, -1, -0.5f}, 10)}, camera_from({0, 0, 3}, vec3(0)),
                        {box_of({-30, -30, z - 1}, {30, 30, z}, -1)});
}

StressScene thick_around(double extinction) {
    return stress_scene({dust(static_cast<float>(extinction))}, {slanting}, camera_from(vec3(0), {0, 0, -1}));
}

// The eye moves by a centimeter: the change of the mean beyond that of the ground truth.
double nudge(Trial& trial) {
    StressScene moved = trial.scene;
    moved.view.camera.position.z -= 0.01f;
    const double before = mean_of(trial.render().inscatter), after = mean_of(trial.render(moved).inscatter);
    const double was = mean_of(trial.truth().inscatter), is = mean_of(trial.truth_of_scene(moved).inscatter);
    return std::abs(after / before - is / was);
}
}

std::vector<StressCase> stress_history() {
    constexpr std::string_view group = "froxels and history";
    return {
        StressCase("light-out", group, "a light goes out", "frames since", "", {4, 2, 1}, Claim::history, {}, lit,
                   {0.02, "share of its light that remains", left_when_out}),
        StressCase("light-dims", group, "a light is dimmed", "to", "", {0.98, 0.9, 0.7, 0.3}, Claim::history, {}, lit,
                   {0.1, "share of it that remains or is missing four frames later", left_when_dimmed}),
        StressCase("film", group, "a gobo's image changes", "frames since", "", {4, 2, 1}, Claim::history, {},
                   first_image, {0.1, "share of the change that is missing", left_of_image}),
        StressCase("door", group, "a door closes", "frames since", "", {4, 2, 1}, Claim::history, trail_of_shadows,
                   open_door, {0.1, "share of the change that is missing", left_of_shadow}),
        StressCase("drifting-puff", group, "fog drifts by half its size", "frames since", "", {4, 2, 1}, Claim::history,
                   trail_of_fog, drifting_puff, {0.1, "share of the change that is missing", left_of_puff}),
        StressCase("moving-light", group, "a spot moves", "distance per frame", "m", {0.002, 0.005, 0.02, 0.1},
                   Claim::history, trail_of_froxels, lit_by_moving,
                   {0.05, "relative RMSE above that without a history", trail}),
        StressCase("uncovered", group, "the camera moves past a pillar", "distance per frame", "m",
                   {0.001, 0.005, 0.02, 0.05, 0.2}, Claim::history, blur_of_froxels, pillar,
                   {0.05, "relative RMSE above that without a history", uncovered}),
        StressCase("cut", group, "cuts: camera, lens, image size, scene", "cut", "", {0, 1, 2, 3}, Claim::history, {},
                   lit, {0, "difference from a frame without history", after_cut}),
        StressCase("bad-frame", group, "a frame of NaN or infinite light is forgotten", "light", "",
                   {NAN, INFINITY, -INFINITY}, Claim::history, unseen, lit, {-1, to_truth, after_bad_frame}),
        StressCase("still", group, "a still image with a history", "frames", "", {8}, Claim::history, unseen, lit,
                   {-1, to_truth, with_history}),
        StressCase("deep-view", group, "fog extends far into the image", "depth", "m", {5, 50, 500, 5000},
                   Claim::physical, {}, deep),
        StressCase("near-wall", group, "a wall comes near: no half slice is lost", "distance", "m", {4, 1, 0.2, 0.03},
                   Claim::physical, {}, near_wall, {0.03, to_truth, nullptr, 2e-3, "march froxel shadow-volume cone"}),
        StressCase("nudge", group, "the camera moves a centimeter in thick fog", "extinction", "1/m", {0.1, 1, 5, 20},
                   Claim::noise_free, blurred, thick_around, {0.01, "change of the mean beyond the truth's", nudge}),
    };
}
}
