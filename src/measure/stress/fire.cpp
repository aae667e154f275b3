// Blackbody emission of fog: flames small and large, near and far, hidden and veiled.
#include "measure/stress/authored.h"
#include "modes/area_light_limitations.h"
#include "modes/froxel/limitations.h"
#include "modes/shadow_map/limitations.h"
#include "modes/shared_limitations.h"
#include "scene/light.h"
#include "scene/mesh.h"
#include "volume/bricks/sparse_volume.h"
#include "volume/medium.h"
#include "volume/phase.h"

#include <algorithm>

namespace tyndall {
namespace {
// Detail of smoke within a step or cell counts as in grids (0.9, data.cpp), one sample per step near a flame as near a
// lamp (2, lamps.cpp).
const std::vector<Excuse> excuses{
    {&limitation::lamps_for_fire},      {&limitation::drawn_as_homogeneous}, {&limitation::unscattered_emission, 2},
    {&limitation::mean_emission_color}, {&limitation::long_steps, 0.9},      {&limitation::light_grid_cells, 0.9},
    {&limitation::deep_steps, 0.9},     {&limitation::deep_froxels, 0.9},    {&limitation::coarse_shafts},
    {&limitation::hard_shadows, 0.5},   {&limitation::few_steps_for_glow, 2}};
const Camera beside = camera_from({0.4f, 0.7f, 3.5f}, {0, 0.6f, 0});

StressScene fire_scene(const Flame& flame, Camera camera = beside, Medium haze = thin_haze(),
                       std::vector<Mesh> meshes = {}) {
    std::vector<Medium> media = burning(flame);
    media.push_back(std::move(haze));
    return authored(std::move(media), {}, camera, std::move(meshes), {lambert(vec3(0))});
}

StressScene of_height(double height) { return fire_scene({.height = static_cast<float>(height)}); }

StressScene from_distance(double distance) {
    return fire_scene({}, camera_from({0, 0.5f, static_cast<float>(distance)}, {0, 0.5f, -1}));
}

// A wall that rises between the fire and the eye.
StressScene behind_wall(double height) {
    return fire_scene({}, beside, thin_haze(), {box_of({-3, -3, 1}, {3, static_cast<float>(height), 1.1f}, 0)});
}

// A box over the fire with a slit in front of it.
StressScene in_oven(double slit) {
    const float low = 0.5f - 0.5f * static_cast<float>(slit), high = 0.5f + 0.5f * static_cast<float>(slit);
    return fire_scene(
        {.height = 0.7f}, camera_from({2.5f, 0.8f, 2.5f}, {0, 0.5f, 0.5f}), thin_haze(0.2f),
        {box_of({-0.7f, -0.1f, 0.6f}, {0.7f, low, 0.7f}, 0), box_of({-0.7f, high, 0.6f}, {0.7f, 1.3f, 0.7f}, 0),
         box_of({-0.7f, -0.1f, -0.7f}, {0.7f, 1.3f, -0.6f}, 0), box_of({-0.7f, -0.1f, -0.7f}, {-0.6f, 1.3f, 0.7f}, 0),
         box_of({0.6f, -0.1f, -0.7f}, {0.7f, 1.3f, 0.7f}, 0), box_of({-0.7f, 1.2f, -0.7f}, {0.7f, 1.3f, 0.7f}, 0)});
}

StressScene in_smoke(double extinction) { return fire_scene({.smoke = static_cast<float>(extinction)}); }
StressScene in_haze(double extinction) { return fire_scene({}, beside, thin_haze(static_cast<float>(extinction))); }
StressScene by_convention(double kind) {
    return fire_scene({.kind = static_cast<BlackbodyKind>(static_cast<int>(kind))});
}
StressScene of_temperature(double kelvin) {
    const float core = static_cast<float>(kelvin);
    return fire_scene({.core = core, .edge = 0.7f * core});
}
StressScene in_droplets(double g) {
    return fire_scene({}, beside, thin_haze(0.1f, forward_phase(static_cast<float>(g))));
}

// A box of fog that emits, 1 m wide, without and with other fog around it.
StressScene emitting_box(double extinction, std::vector<Medium> around) {
    Medium fog = thin_haze(static_cast<float>(extinction));
    fog.density.bounds = fog.world_bounds = {{-0.5f, 0.1f, -0.5f}, {0.5f, 1.1f, 0.5f}};
    fog.optics.emission.radiance = vec3(2, 3, 1) * static_cast<float>(std::max(extinction, 0.5));
    around.push_back(std::move(fog));
    return authored(std::move(around), {}, beside);
}
StressScene emitting_fog(double extinction) { return emitting_box(extinction, {}); }
StressScene emitting_in_haze(double extinction) {
    return emitting_box(0.2, {thin_haze(static_cast<float>(extinction))});
}

// Endless fog that emits.
StressScene emitting_haze(double albedo) {
    Medium fog = thin_haze();
    fog.density.bounds = fog.world_bounds = everywhere();
    fog.optics.albedo = vec3(static_cast<float>(albedo)), fog.optics.emission.radiance = vec3(0.02f);
    return authored({std::move(fog)}, {}, beside, {box_of({-0.3f, 0, -0.3f}, {0.3f, 1, 0.3f}, 0)}, {lambert(vec3(0))});
}

StressScene in_a_row(double count) {
    std::vector<Medium> media{thin_haze()};
    const int n = static_cast<int>(count);
    for (int i = 0; i < n; ++i) {
        const float x = 4 * (static_cast<float>(i) + 0.5f) / static_cast<float>(n) - 2;
        for (Medium& medium : burning({.base = {x, 0, 0}, .height = 0.6f})) media.push_back(std::move(medium));
    }
    return authored(std::move(media), {}, beside);
}
}

std::vector<StressCase> stress_fire() {
    constexpr std::string_view group = "fire";
    const StressMeasure usual = default_measure();
    return {
        StressCase("small-fire", group, "a flame shrinks below a pixel", "height", "m", {1, 0.3, 0.05}, Claim::physical,
                   excuses, of_height, usual),
        StressCase("eye-in-fire", group, "the camera comes near a fire and enters it", "camera to axis", "m",
                   {3, 1.2, 0.4, 0.05}, Claim::physical, excuses, from_distance, usual),
        StressCase("fire-behind-wall", group, "a wall rises before a fire", "height", "m", {-1, 0.3, 0.6, 1.2},
                   Claim::physical, excuses, behind_wall, usual),
        StressCase("oven", group, "a fire in a box whose slit gets narrow", "slit", "m", {0.8, 0.3, 0.08},
                   Claim::physical, excuses, in_oven, usual),
        StressCase("smoky-fire", group, "a fire's own smoke gets thick", "extinction", "1/m", {0.1, 1, 5, 20},
                   Claim::physical, excuses, in_smoke, usual),
        StressCase("fire-in-haze", group, "the fog that a fire lights gets thick", "extinction", "1/m",
                   {0.01, 0.1, 0.5, 2}, Claim::physical, excuses, in_haze, usual),
        StressCase("fire-conventions", group, "temperature to light by the conventions kelvin, cycles, pbrt",
                   "convention", "", {0, 1, 2}, Claim::physical, excuses, by_convention, usual),
        StressCase("embers", group, "from embers to the hottest flames", "temperature", "K",
                   {600, 1000, 1500, 2000, 3000}, Claim::physical, excuses, of_temperature, usual),
        StressCase("fire-in-droplets", group, "forward-scattering haze around a fire", "g", "", {0, 0.6, 0.9},
                   Claim::physical, excuses, in_droplets, usual),
        StressCase("emitting-fog", group, "fog whose emission follows its density gets thick", "extinction", "1/m",
                   {0.1, 1, 10}, Claim::physical, excuses, emitting_fog, usual),
        StressCase("emitting-fog-in-haze", group, "the fog around it gets thick", "extinction", "1/m", {0.02, 0.2, 1},
                   Claim::physical, excuses, emitting_in_haze, usual),
        StressCase("emitting-haze", group, "endless fog that emits scatters more of its light", "albedo", "",
                   {0, 0.5, 0.95}, Claim::physical, excuses, emitting_haze, usual),
        StressCase("many-fires", group, "several fires at once", "fires", "", {1, 3, 8}, Claim::physical, excuses,
                   in_a_row, usual),
    };
}
}
