// Checks that need no expected value: what must not change when the same fog or scene is described in another way.
#include "measure/verify/rays.h"
#include "scene/lights/light_kind.h"
#include "scene/mesh.h"
#include "scene/scene.h"
#include "volume/bricks/sparse_volume.h"
#include "volume/phase.h"

#include "base/random.h"
#include "scene/light.h"
#include "trace/snapshot.h"
#include "volume/medium.h"

namespace tyndall {
namespace {
// Random values in 6³ voxels with nothing around them.
float rough(ivec3 cell) {
    if (glm::any(glm::lessThan(cell, ivec3(1))) || glm::any(glm::greaterThan(cell, ivec3(6)))) return 0;
    return to_unit(hash(static_cast<uint32_t>(cell.x), static_cast<uint32_t>(cell.y), static_cast<uint32_t>(cell.z)));
}

// The same, interpolated trilinearly between voxel centers.
float interpolated(vec3 p) {
    const vec3 at = p * 8.0f - 0.5f, corner = glm::floor(at), share = at - corner;
    float sum = 0;
    for (int i = 0; i < 8; ++i) {
        const ivec3 off(i & 1, i >> 1 & 1, i >> 2), cell = ivec3(corner) + off;
        const vec3 weight = glm::mix(1.0f - share, share, vec3(off));
        sum += weight.x * weight.y * weight.z * rough(cell);
    }
    return sum;
}

void check_grids(Checks& checks) {
    // Along an axis every voxel center counts for one voxel, the fading ends included.
    const Medium full = grid_medium(3, 64, [](vec3) { return 0.5f; });
    const Ray across{{-1, 0.5f, 0.5f}, {1, 0, 0}, 3};
    checks.add("optical depth of a grid of one value", optical_depth(full, across), 1.5, 1e-6, "rounding");

    // Inside, the fog is the same as in a homogeneous medium.
    const Medium even = homogeneous_medium(1.5f, {vec3(0), vec3(1)});
    const Ray inside{{0.5f, 0.5f, 0.9f}, {0, 0, -1}, 0.8f};
    const Light sun = sun_light({0.2f, -1, 0.1f}, 1);
    const double expected = reference_light(snapshot_of({even}, {sun}), inside).radiance.x;
    checks.add("light in a grid of one value, and in homogeneous fog",
               reference_light(snapshot_of({full}, {sun}), inside).radiance.x, expected, 1e-4 * expected, "1e-4");

    // At three times the resolution, voxel centers and the cubes between them stay where they are.
    const Medium coarse = grid_medium(3, 8, [](vec3 p) { return rough(ivec3(p * 8.0f)); });
    const Medium fine = grid_medium(3, 24, interpolated);
    double worst = 0;
    for (uint32_t i = 0; i < 64; ++i) {
        const vec3 from(-0.5f, random_unit(i, 0, 0, 1), random_unit(i, 0, 1, 1)),
            to(1.5f, random_unit(i, 0, 2, 1), random_unit(i, 0, 3, 1));
        const Ray ray{from, glm::normalize(to - from), 3};
        const double a = optical_depth(coarse, ray), b = optical_depth(fine, ray);
        if (a > 0.3) worst = std::max(worst, std::abs(b / a - 1));
    }
    checks.add("optical depth of a grid made three times as fine, worst of 64 rays", 1 + worst, 1, 1e-3, "half floats");

    Medium half = noise_medium(1.5f);
    const Snapshot once = snapshot_of({noise_medium(3)}, {sun}), twice = snapshot_of({half, half}, {sun});
    const Ray ray{{0.4f, 0.3f, 3}, {0, 0, -1}, 9};
    const double whole = reference_light(once, ray).radiance.x;
    checks.add("light of one fog, and of two halves of it", reference_light(twice, ray).radiance.x, whole, 1e-4 * whole,
               "1e-4");
}

// A room with a slatted window, sun, a spot and rough fog.
Scene slatted_room() {
    Scene scene;
    Material gray;
    gray.base_color = vec3(0.5f, 0.45f, 0.4f);
    scene.materials = {gray};
    const auto add = [&](vec3 low, vec3 high) {
        scene.meshes.push_back(box_of(low, high, 0));
        scene.instances.push_back({-1, static_cast<int>(scene.meshes.size()) - 1});
    };
    add({-2, -0.2f, -2}, {2, 0, 2}), add({-2, 2, -2}, {2, 2.2f, 2}), add({-2, 0, -2.2f}, {2, 2, -2});
    for (int i = 0; i < 6; ++i) {
        const float y = 0.4f + 0.25f * static_cast<float>(i);
        add({-2.1f, y, -2}, {-2, y + 0.12f, 2});
    }
    LightSource sun, spot;
    sun.name = "sun", sun.kind = LightKind::sun, sun.intensity = 30.0f;
    sun.direction = vec3(0.8f, -0.5f, 0.1f);
    spot.name = "spot", spot.kind = LightKind::spot, spot.intensity = 20.0f, spot.color = vec3(0.4f, 0.7f, 1);
    spot.position = vec3(0.8f, 1.9f, -0.5f), spot.direction = vec3(-0.2f, -1, 0);
    spot.inner_cone = 0.2f, spot.outer_cone = 0.4f;
    scene.lights = {sun, spot};
    MediumSource dust;
    dust.name = "dust", dust.kind = MediumKind::noise, dust.extinction = 0.4f, dust.g = 0.4f;
    dust.albedo = vec3(0.9f, 0.85f, 0.8f);
    FogRecipe recipe;
    recipe.bounds = {vec3(-2.5f, 0, -2), vec3(2, 2, 2)}, recipe.voxel_size = 0.1;
    recipe.threshold = 0.3f;
    dust.recipe = recipe;
    scene.media = {dust};
    CameraSource camera;
    camera.name = "door", camera.position = vec3(1.6f, 1.1f, 1.9f), camera.target = vec3(-1, 1, -1);
    scene.cameras = {camera};
    return scene;
}
}

std::vector<CheckGroup> invariance_checks() { return {{"the same fog described twice", 1, check_grids}}; }

std::vector<Check> verify_program(const VerifyControl& control) {
    std::vector<CheckGroup> groups = closed_form_checks();
    for (const auto& more : {transport_checks(), invariance_checks()})
        groups.insert(groups.end(), more.begin(), more.end());
    constexpr double rays_share = 0.7;
    VerifyControl first = control, second = control;
    if (control.progress) {
        first.progress = [&](double done) { control.progress(rays_share * done); };
        second.progress = [&](double done) { control.progress(rays_share + (1 - rays_share) * done); };
    }
    std::vector<Check> checks = run_checks(groups, first);
    const Scene room = slatted_room();
    VerifyOptions options;
    options.size = {128, 72}, options.samples = 512;
    for (Check& check : verify_scene(room, options, second)) {
        check.topic = "a slatted room: " + check.topic;
        checks.push_back(std::move(check));
    }
    return checks;
}
}
