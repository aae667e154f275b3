// Surfaces that block light: slits, wires, rooms, meshes of every quality, eyes in shadow.
#include "measure/stress/trial.h"
#include "modes/froxel/limitations.h"
#include "modes/map_shadows.h"
#include "modes/mode.h"
#include "modes/shadow_map/limitations.h"
#include "modes/shadow_volume/limitations.h"
#include "modes/shared_limitations.h"
#include "scene/light.h"
#include "scene/mesh.h"
#include "scene/scene.h"
#include "volume/bricks/sparse_volume.h"
#include "volume/medium.h"
#include "volume/phase.h"

namespace tyndall {
namespace {
const Excuse as_froxels{&limitation::coarse_shafts}, as_noise{&limitation::grainy_edges};
// Four samples in each of 24 steps. Light that fills a third of the distance between them, as in the narrowest shafts
// here, has a relative error of sqrt(1 / 0.3 - 1) = 1.5.
const std::vector<Excuse> narrow{as_froxels, {as_noise.kind, 1.5}, shadows_ignored};
// For shadows much wider than froxels, steps and texels.
const StressMeasure sharp{0.03, to_truth, nullptr, 1e-3, "march shadow-volume"};
const StressMeasure fine{-1, to_truth, nullptr, 1e-3, "march shadow-volume"};
// Penumbrae as wide as the gap: up to half of its light falls elsewhere.
const std::vector<Excuse> hard{{&limitation::hard_shadows, 0.5}, as_froxels};

Medium dust(float extinction = 0.15f) {
    return homogeneous_medium(extinction, {vec3(-3), vec3(3)}, forward_phase(0.3f));
}
const Light slanting = sun_light({0.5f, -1, 0.1f}, 10);
const Camera aside = camera_from({0, 0, 7}, vec3(0));

// A roof with a gap that is off-center, so that no ray runs along the face of a shaft.
std::vector<Mesh> roof_with_slit(float width, float height = 2, float middle = 0.137f) {
    const float low = middle - 0.5f * width, high = middle + 0.5f * width;
    return {quad({-20, height, -20}, {20 + low, 0, 0}, {0, 0, 40}),
            quad({high, height, -20}, {20 - high, 0, 0}, {0, 0, 40})};
}

StressScene slit(double width) {
    return stress_scene({dust()}, {slanting}, aside, roof_with_slit(static_cast<float>(width)));
}

StressScene lit_floor(double elevation) {
    const float e = static_cast<float>(elevation) * pi / 180;
    return stress_scene({dust()}, {sun_light({std::cos(e), -std::sin(e), 0}, 10)},
                        camera_from({0, 1, 5}, {0, -0.5f, 0}), {quad({-20, -1, -20}, {40, 0, 0}, {0, 0, 40})});
}

StressScene orbit(double azimuth) {
    const float a = static_cast<float>(azimuth) * pi / 180;
    return stress_scene({dust()}, {slanting}, camera_from({6 * std::sin(a), 1, 6 * std::cos(a)}, vec3(0)),
                        {box_of({-0.8f, 0.5f, -0.8f}, {0.8f, 1.2f, 0.8f}, -1)});
}

// The sun shines towards the eye, along the middle ray.
StressScene along_the_sun(double angle) {
    const float a = static_cast<float>(angle) * pi / 180;
    return stress_scene({dust()}, {sun_light({std::sin(a), 0, std::cos(a)}, 10)}, aside,
                        {box_of({-0.5f, -0.4f, -2.5f}, {0.6f, 0.7f, -2}, -1)});
}

// Wires placed so that no ray runs along the face of a shadow.
StressScene fence(double wire) {
    std::vector<Mesh> meshes;
    const float w = static_cast<float>(wire);
    for (int i = -12; i <= 12; ++i)
        meshes.push_back(quad({0.25f * static_cast<float>(i) + 0.037f, 2, -3}, {w, 0, 0}, {0, 0, 6}));
    return stress_scene({dust()}, {slanting}, aside, meshes);
}

// A square with a square hole: one mesh, pieces whose edges do not match, or triangles flipped, mixed or doubled.
enum class Sheet { one, pieces, flipped, mixed, doubled };
StressScene holed(double kind) {
    Mesh mesh;
    const float at[] = {-20, -0.6f, 0.7f, 20};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            if (i == 1 && j == 1) continue;
            const Mesh part = quad({at[i], 2, at[j]}, {at[i + 1] - at[i], 0, 0}, {0, 0, at[j + 1] - at[j]});
            const auto first = static_cast<uint32_t>(mesh.positions.size());
            mesh.positions.insert(mesh.positions.end(), part.positions.begin(), part.positions.end());
            for (glm::uvec3 triangle : part.triangles) {
                const auto sheet = static_cast<Sheet>(static_cast<int>(kind));
                const bool turned = sheet == Sheet::flipped || (sheet == Sheet::mixed && (i + j) % 2);
                if (turned) std::swap(triangle.y, triangle.z);
                mesh.triangles.push_back(triangle + first);
                if (sheet == Sheet::doubled) mesh.triangles.push_back(mesh.triangles.back());
            }
        }
    std::vector<Mesh> meshes{mesh};
    if (static_cast<Sheet>(static_cast<int>(kind)) == Sheet::pieces)
        meshes = {quad({-20, 2, -20}, {19.4f, 0, 0}, {0, 0, 40}), quad({0.7f, 2, -20}, {19.3f, 0, 0}, {0, 0, 40}),
                  quad({-0.6f, 2, -20}, {1.3f, 0, 0}, {0, 0, 19.4f}),
                  quad({-0.6f, 2, 0.7f}, {1.3f, 0, 0}, {0, 0, 19.3f})};
    return stress_scene({dust()}, {slanting}, aside, meshes);
}

// The sun in the plane of a box's face.
StressScene coplanar(double angle) {
    const float a = static_cast<float>(angle);
    return stress_scene({dust()}, {sun_light({a, -1, 0}, 10)}, aside,
                        {box_of({-0.8f, 0.5f, -0.8f}, {0.8f, 1.2f, 0.8f}, -1)});
}

StressScene stack(int count) {
    std::vector<Mesh> meshes;
    for (int i = 0; i < count; ++i) meshes.push_back(box_of({-1, 1, -1}, {1, 1.2f, 1}, -1));
    return stress_scene({dust()}, {slanting, point_light({0.5f, 2.5f, 0}, 10)}, aside, meshes);
}
StressScene one_blocker(double) { return stack(1); }
double stack_off(Trial& trial) {
    return difference(trial.render(stack(static_cast<int>(trial.value))), trial.render());
}

StressScene eye_in_shadow(double depth) {
    const float y = 0.5f - static_cast<float>(depth);
    return stress_scene({dust()}, {slanting}, camera_from({0.3f, y, 0.2f}, {1, y - 0.4f, -3}),
                        {box_of({-1, 0.5f, -1}, {1, 0.7f, 1}, -1)});
}

StressScene long_shadow(double size) {
    const float s = static_cast<float>(size);
    return stress_scene({homogeneous_medium(0.5f / s, {vec3(-3 * s), vec3(3 * s)})}, {slanting},
                        camera_from({0, 0, 6 * s}, vec3(0)), {box_of(vec3(-s, 0.8f * s, -s), vec3(s), -1)});
}

// The walls of a room around the eye, fog inside and out, the sun outside.
std::vector<Mesh> room(float wall) {
    std::vector<Mesh> meshes;
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-1.0f, 1.0f}) {
            vec3 low(-2 - wall), high(2 + wall);
            (side < 0 ? high : low)[axis] = 2 * side, (side < 0 ? low : high)[axis] = (2 + wall) * side;
            meshes.push_back(box_of(low, high, -1));
        }
    return meshes;
}
StressScene dark_room(double wall) {
    return stress_scene({homogeneous_medium(0.15f, {vec3(-6), vec3(6)})}, {sun_light({0.4f, -1, -0.7f}, 1e5f)},
                        camera_from({0.3f, 0.1f, 1.7f}, {0, 0, -2}), room(static_cast<float>(wall)));
}

// A closed roof of n x n squares.
StressScene tessellated(double squares) {
    const int n = static_cast<int>(squares);
    Mesh mesh;
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j)
            mesh.positions.push_back({-20 + 40.0f * static_cast<float>(i) / static_cast<float>(n),
                                      2 + 0.01f * static_cast<float>((i * 7 + j * 3) % 5),
                                      -20 + 40.0f * static_cast<float>(j) / static_cast<float>(n)});
    const auto at = [&](int i, int j) { return static_cast<uint32_t>(i * (n + 1) + j); };
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return stress_scene({homogeneous_medium(0.15f, {vec3(-3, -3, -3), vec3(3, 1.9f, 3)})}, {slanting}, aside, {mesh});
}

double brightest(Trial& trial) { return max_of(trial.render().inscatter); }

StressScene soft(double angle) {
    Light sun = slanting;
    sun.angle = static_cast<float>(angle);
    return stress_scene({dust()}, {sun}, aside, roof_with_slit(0.8f));
}

StressScene soft_lamp(double radius) {
    Light light = point_light({0.2f, 2.8f, 0}, 20);
    light.radius = static_cast<float>(radius);
    return stress_scene({dust()}, {light}, camera_from({0, -0.5f, 7}, {0, -0.5f, 0}, 0.5f), roof_with_slit(0.8f));
}

StressScene glass(double alpha) {
    Material material;
    material.alpha_mode = AlphaMode::blend, material.alpha = static_cast<float>(alpha);
    std::vector<Mesh> meshes{quad({-1, 2, -3}, {2, 0, 0}, {0, 0, 6}, 0)};
    return stress_scene({dust()}, {slanting}, aside, meshes, {material});
}

// A sheet whose texture cuts away its left part.
StressScene cut_out(double share) {
    Material material;
    material.alpha_mode = AlphaMode::mask, material.base_texture = 0;
    Image<vec4> image(ivec2(64, 1), vec4(1));
    for (int x = 0; x < static_cast<int>(64 * share); ++x) image.at(x, 0).w = 0;
    Texture texture;
    texture.texels = shared_texels(std::move(image)), texture.nearest = true;
    StressScene scene = stress_scene({dust()}, {slanting}, aside);
    scene.scene->materials = {material}, scene.scene->textures = {texture};
    scene.scene->meshes = {quad({-1.5f, 2, -3}, {3, 0, 0}, {0, 0, 6}, 0)};
    scene.scene->instances = {{-1, 0}};
    add_surfaces(*scene.scene, scene.snapshot);
    return scene;
}

StressScene lamp_in_holes(double distance) {
    // A plate with a hole, closer and closer to the lamp behind it.
    const float y = 2 - static_cast<float>(distance), half = 0.25f * static_cast<float>(distance);
    std::vector<Mesh> meshes = roof_with_slit(2 * half, y, 0);
    return stress_scene({dust()}, {point_light({0, 2, 0}, 20)}, camera_from({0, -0.8f, 6}, {0, -0.8f, 0}, 0.5f),
                        meshes);
}

// Rays of no length, or nearly none.
StressScene short_rays(double) { return slit(0.8); }
double short_rays_off(Trial& trial) {
    const StressScene& scene = trial.scene;
    const ScatterFunction scatter = trial.mode->prepare(scene.view, scene.snapshot, scene.settings, nullptr);
    std::vector<Ray> rays(16);
    std::vector<uint32_t> ids(16, 3);
    std::vector<SampleIndex> sample_indices(16);
    for (size_t i = 0; i < rays.size(); ++i) {
        rays[i] = camera_ray(scene.view.camera, scene.view.size, vec2(3.0f * static_cast<float>(i), 13));
        rays[i].t_max = static_cast<float>(trial.value);
    }
    std::vector<Scatter> results(16);
    scatter({.rays = rays, .ids = ids, .sample_indices = sample_indices}, results);
    double most = 0;
    for (const Scatter& result : results) {
        trial.faults.non_finite += !is_finite(result.radiance) || !std::isfinite(result.transmittance);
        trial.faults.negative += std::min(result.radiance.x, result.transmittance) < 0 || result.transmittance > 1;
        most = std::max({most, std::abs(1.0 - result.transmittance), double(max_component(result.radiance))});
    }
    return most;
}
}

std::vector<StressCase> stress_shadows() {
    constexpr std::string_view group = "shadows";
    return {
        StressCase("slit", group, "sun through a slit that gets narrow", "width", "m", {2, 0.5, 0.1, 0.02},
                   Claim::physical, narrow, slit, fine),
        StressCase("lit-floor", group, "a lit floor does not shadow itself", "sun's elevation", "degrees",
                   {89, 45, 10, 3, 1}, Claim::physical, {}, lit_floor, sharp),
        StressCase("orbit", group, "the camera goes around a shaft of shadow", "azimuth", "degrees",
                   {0, 60, 120, 180, 240, 300}, Claim::physical, {shadows_ignored}, orbit, sharp),
        StressCase("against-the-sun", group, "rays become parallel to the sun's", "ray to sun", "degrees",
                   {30, 5, 1, 0.01, 0}, Claim::physical, {shadows_ignored}, along_the_sun, sharp),
        StressCase("fence", group, "wires get thinner than texels and froxels", "wire", "m", {0.12, 0.03, 0.008, 0.002},
                   Claim::physical, {as_froxels, as_noise, shadows_ignored}, fence, fine),
        StressCase("holed-sheet", group, "one hole in a sheet: whole, in pieces, turned, half turned, doubled", "mesh",
                   "", {0, 1, 2, 3, 4}, Claim::shadows, {}, holed, fine),
        StressCase("sun-in-a-face", group, "the sun lies in the plane of a face", "angle", "radians",
                   {0.1, 1e-2, 1e-4, 1e-7, 0}, Claim::shadows, {}, coplanar, sharp),
        StressCase("stack", group, "several blockers in one place act as one", "blockers", "", {2, 3, 5},
                   Claim::shadows | Claim::noise_free, {}, one_blocker, {1e-3, "relative RMSE against one", stack_off}),
        StressCase("eye-in-shadow", group, "the camera is in a shadow", "below the blocker", "m", {3, 1, 0.3, 0.01},
                   Claim::physical, {shadows_ignored}, eye_in_shadow, sharp),
        StressCase("size", group, "shadows a thousand kilometers long", "blocker", "m", {1, 1e-3, 1e3, 1e6},
                   Claim::shadows, {}, long_shadow, sharp),
        StressCase("dark-room", group, "the sun does not get through thin walls", "wall", "m", {0.5, 0.1, 0.02, 0.005},
                   Claim::shadows, {}, dark_room, {1e-3, "light inside / light without walls", leak}),
        StressCase("closed-roof", group, "no light through the seams of triangles", "squares", "per side", {1, 8, 64},
                   Claim::shadows, {}, tessellated, {0, "brightest pixel", brightest}),
        StressCase("soft-sun", group, "the disc of the sun gets large", "half angle", "radians", {0, 0.005, 0.05, 0.2},
                   Claim::shadows, hard, soft),
        StressCase("soft-lamp", group, "a lamp gets large", "radius", "m", {0, 0.02, 0.1, 0.3}, Claim::shadows, hard,
                   soft_lamp),
        StressCase("glass", group, "a pane that blocks part of the light", "alpha", "", {1, 0.8, 0.4, 0.1},
                   Claim::shadows, {{&limitation::no_alpha_shadows}, {&limitation::no_partial_shadows}, as_froxels},
                   glass),
        StressCase("cut-out", group, "a sheet with a hole in its texture", "hole", "", {0.5, 0.1, 0.02, 0.9},
                   Claim::shadows, {{&limitation::no_alpha_shadows}, as_froxels, as_noise}, cut_out),
        StressCase("shade-at-lamp", group, "a slit comes close to its lamp", "lamp to slit", "m", {1, 0.3, 0.03, 0.003},
                   Claim::physical, {as_froxels, as_noise, shadows_ignored}, lamp_in_holes, fine),
        StressCase("short-rays", group, "rays that end where they start", "length", "m", {1e-5, 1e-9, 0},
                   Claim::along_rays, {}, short_rays, {1e-3, "most light scattered or absorbed", short_rays_off}),
    };
}
}
