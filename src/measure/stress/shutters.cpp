// Depth of field, motion blur and matte objects.
#include "measure/stress/authored.h"
#include "modes/froxel/limitations.h"
#include "modes/lens_fog.h"
#include "modes/light_filters.h"
#include "modes/limitation.h"
#include "modes/shadow_map/limitations.h"
#include "modes/shared_limitations.h"
#include "scene/light.h"
#include "scene/mesh.h"
#include "volume/bricks/sparse_volume.h"
#include "volume/medium.h"
#include "volume/phase.h"

namespace tyndall {
namespace {
const std::vector<Excuse> excuses{{&limitation::fog_through_middle},    {&limitation::shutter_moments},
                                  {&limitation::few_steps_for_glow, 2}, {&limitation::coarse_shafts},
                                  {&limitation::grainy_edges, 1.5},     shadows_ignored,
                                  {&limitation::blurred_filter, 0.5},   {&limitation::sampled_gobo, 0.5}};

// --- lenses --------------------------------------------------------------------------------------------------------
// A spot's beam two meters behind a post.
StressScene through_lens(float radius, float focus) {
    Camera camera = camera_from({0, 0, 4}, vec3(0));
    camera.lens.radius = radius, camera.lens.focus = focus;
    return authored({thin_haze()}, {spot_light({0, 1.5f, 0}, {0, -1, 0}, 10, 0.15f, 0.2f)}, camera,
                    {box_of({0.3f, -2, 1.9f}, {0.5f, 2, 2}, 0)}, {lambert(vec3(0))});
}
StressScene of_radius(double radius) { return through_lens(static_cast<float>(radius), 4); }
StressScene of_focus(double focus) { return through_lens(0.05f, static_cast<float>(focus)); }

// --- shutters ------------------------------------------------------------------------------------------------------
template<class T> Keyed<T> from_to(T first, T last) {
    Keyed<T> keys;
    keys.times = {0, 1}, keys.values = {first, last};
    return keys;
}

Scene still_scene() {
    Scene scene;
    CameraSource& camera = scene.cameras.emplace_back();
    camera.position = vec3(0, 0, 5), camera.target = vec3(0);
    MediumSource& haze = scene.media.emplace_back();
    haze.name = "haze", haze.bounds = {vec3(-3), vec3(3)};
    LightSource& spot = scene.lights.emplace_back();
    spot.name = "spot", spot.kind = LightKind::spot, spot.intensity = 10.0f;
    spot.position = vec3(0, 2, 0), spot.inner_cone = 0.12f, spot.outer_cone = 0.16f;
    return scene;
}

void add_box(Scene& scene, vec3 low, vec3 high, int node = -1, bool matte = false) {
    scene.materials = {lambert(vec3(0))};
    scene.meshes.push_back(box_of(low, high, 0));
    Instance instance;
    instance.node = node, instance.mesh = static_cast<int>(scene.meshes.size()) - 1, instance.matte = matte;
    scene.instances.push_back(instance);
}

StressScene fast_spot(double degrees) {
    Scene scene = still_scene();
    const float a = 0.5f * static_cast<float>(degrees) * pi / 180;
    scene.lights[0].direction = from_to(vec3(-std::sin(a), -std::cos(a), 0), vec3(std::sin(a), -std::cos(a), 0));
    return shuttered(std::move(scene), 0, 1);
}

StressScene fast_lamp(double way) {
    Scene scene = still_scene();
    const float half = 0.5f * static_cast<float>(way);
    scene.lights[0].kind = LightKind::point;
    scene.lights[0].position = from_to(vec3(-half, 0.3f, 0), vec3(half, 0.3f, 0));
    return shuttered(std::move(scene), 0, 1);
}

// A post that moves across a wide beam.
StressScene fast_post(double way) {
    Scene scene = still_scene();
    const float half = 0.5f * static_cast<float>(way);
    scene.lights[0].inner_cone = 0.5f, scene.lights[0].outer_cone = 0.6f;
    Node node;
    node.translation = from_to(vec3(-half, 0, 0), vec3(half, 0, 0));
    scene.nodes.push_back(node);
    add_box(scene, {-0.15f, 1, -2}, {0.15f, 1.1f, 2}, 0);
    return shuttered(std::move(scene), 0, 1);
}

// A bar in a wide beam; a morph target moves one of its ends.
StressScene swinging_bar(double way) {
    Scene scene = still_scene();
    scene.lights[0].inner_cone = 0.5f, scene.lights[0].outer_cone = 0.6f;
    add_box(scene, {-0.1f, 1, -2}, {0.1f, 1.1f, 2});
    MorphTarget& target = scene.meshes[0].targets.emplace_back();
    for (const vec3& position : scene.meshes[0].positions)
        target.positions.emplace_back(position.z > 0 ? static_cast<float>(way) : 0, 0, 0);
    scene.instances[0].target_weights = {from_to(0.0f, 1.0f)};
    return shuttered(std::move(scene), 0, 1);
}

// A bar whose far end turns at a joint in the middle of the beam.
StressScene bending_bar(double degrees) {
    Scene scene = still_scene();
    scene.lights[0].inner_cone = 0.5f, scene.lights[0].outer_cone = 0.6f;
    Node joint;
    joint.rotation = from_to(quat(1, 0, 0, 0), glm::angleAxis(static_cast<float>(degrees) * pi / 180, vec3(0, 1, 0)));
    scene.nodes = {Node{}, joint};
    scene.skins = {{{0, 1}, {mat4(1), mat4(1)}}};
    add_box(scene, {-0.7f, 1, -0.1f}, {0.7f, 1.1f, 0.1f});
    Mesh& bar = scene.meshes[0];
    bar.influences = 1, bar.joint_count = 2;
    for (const vec3& position : bar.positions) bar.joints.push_back(position.x > 0), bar.joint_weights.push_back(1);
    scene.instances[0].skin = 0;
    return shuttered(std::move(scene), 0, 1);
}

StressScene fast_eye(double way) {
    Scene scene = still_scene();
    const vec3 half(0.5f * static_cast<float>(way), 0, 0);
    scene.cameras[0].position = from_to(vec3(0, 0, 5) - half, vec3(0, 0, 5) + half);
    scene.cameras[0].target = from_to(-half, half);
    return shuttered(std::move(scene), 0, 1);
}

StressScene fast_cloud(double way) {
    Scene scene = still_scene();
    const float half = 0.5f * static_cast<float>(way);
    MediumSource& cloud = scene.media.emplace_back();
    cloud.name = "cloud", cloud.extinction = 1.0f, cloud.bounds = {vec3(-0.5f), vec3(0.5f)};
    cloud.translation = from_to(vec3(-half, 0, 0), vec3(half, 0, 0));
    scene.lights[0].kind = LightKind::sun, scene.lights[0].direction = vec3(0.3f, -1, -0.2f);
    return shuttered(std::move(scene), 0, 1);
}

StressScene spinning_gobo(double degrees) {
    Scene scene = still_scene();
    LightSource& spot = scene.lights[0];
    spot.inner_cone = 0.35f, spot.outer_cone = 0.4f;
    GoboSource& gobo = spot.gobo.emplace();
    gobo.still = board_gobo(2, 4, vec3(1), vec3(0.05f));
    gobo.rotation = from_to(0.0f, static_cast<float>(degrees) * pi / 180);
    return shuttered(std::move(scene), 0, 1);
}

StressScene fading_lamp(double stops) {
    Scene scene = still_scene();
    scene.lights[0].direction = from_to(vec3(-0.05f, -1, 0), vec3(0.05f, -1, 0));
    scene.lights[0].exposure = from_to(0.0f, static_cast<float>(-stops));
    return shuttered(std::move(scene), 0, 1);
}

// --- mattes --------------------------------------------------------------------------------------------------------
StressScene matte_post(double width) {
    const float half = 0.5f * static_cast<float>(width);
    StressScene scene = stress_scene({thin_haze()}, {sun_light({0.5f, -1, 0.1f}, 10)}, camera_from({0, 0, 5}, vec3(0)),
                                     {box_of({-half, -1, -0.2f}, {half, 1, 0.2f}, 0)}, {lambert(vec3(1))});
    scene.scene->instances[0].matte = true;
    return scene;
}
StressScene matte_before(double distance) {
    const float z = 5 - static_cast<float>(distance);
    StressScene scene = stress_scene({thin_haze()}, {spot_light({0, 1.5f, 0}, {0, -1, 0}, 10, 0.3f, 0.4f)},
                                     camera_from({0, 0, 5}, vec3(0)), {quad({-0.3f, -5, z}, {5, 0, 0}, {0, 10, 0}, 0)},
                                     {lambert(vec3(1))});
    scene.scene->instances[0].matte = true;
    return scene;
}
}

std::vector<StressCase> stress_shutters() {
    constexpr std::string_view lens = "lenses", shutter = "open shutters", matte = "mattes";
    const StressMeasure usual = default_measure();
    return {
        StressCase("wide-lens", lens, "a lens opens", "radius", "m", {0.002, 0.05, 0.3}, Claim::physical, excuses,
                   of_radius, usual),
        StressCase("near-focus", lens, "the focus comes near", "distance", "m", {4, 2, 0.7}, Claim::physical, excuses,
                   of_focus, usual),
        StressCase("fast-spot", shutter, "a spot turns while the shutter is open", "angle", "degrees", {0, 10, 40, 90},
                   Claim::physical, excuses, fast_spot, usual),
        StressCase("fast-lamp", shutter, "a lamp moves", "distance", "m", {0, 0.5, 3}, Claim::physical, excuses,
                   fast_lamp, usual),
        StressCase("fast-post", shutter, "a post moves through a beam", "distance", "m", {0, 0.5, 2}, Claim::physical,
                   excuses, fast_post, usual),
        StressCase("swinging-bar", shutter, "a morph target moves one end of a bar in a beam", "distance", "m",
                   {0, 0.5, 2}, Claim::physical, excuses, swinging_bar, usual),
        StressCase("bending-bar", shutter, "a bar in a beam bends at a joint", "angle", "degrees", {0, 20, 90},
                   Claim::physical, excuses, bending_bar, usual),
        StressCase("fast-eye", shutter, "the camera moves", "distance", "m", {0, 0.3, 2}, Claim::physical, excuses,
                   fast_eye, usual),
        StressCase("fast-cloud", shutter, "a cloud moves", "distance", "m", {0, 0.5, 3}, Claim::physical, excuses,
                   fast_cloud, usual),
        StressCase("spinning-gobo", shutter, "a gobo turns", "angle", "degrees", {0, 20, 90}, Claim::physical, excuses,
                   spinning_gobo, usual),
        StressCase("fading-lamp", shutter, "a lamp goes out while it turns", "drop", "stops", {0, 2, 10},
                   Claim::physical, excuses, fading_lamp, usual),
        StressCase("matte-post", matte, "a holdout post gets thin", "width", "m", {1, 0.3, 0.05}, Claim::physical,
                   excuses, matte_post, usual),
        StressCase("matte-before-eye", matte, "it comes near the camera", "distance", "m", {4, 2, 0.2}, Claim::physical,
                   excuses, matte_before, usual),
    };
}
}
