// Environment light: half a sky, suns in maps, thick fog, roofs.
#include "measure/stress/authored.h"
#include "modes/area_light_limitations.h"
#include "modes/limitation.h"
#include "modes/shared_limitations.h"
#include "scene/light.h"
#include "scene/mesh.h"
#include "volume/bricks/sparse_volume.h"
#include "volume/medium.h"
#include "volume/phase.h"

namespace tyndall {
namespace {
const std::vector<Excuse> excuses{{&limitation::mean_environment, 0, stated_error}};
const Camera front = camera_from({0, 0.3f, 5}, vec3(0));
const vec3 sunwards = glm::normalize(vec3(0.3f, 0.6f, -1));

StressScene under(std::shared_ptr<const Environment> sky, Medium fog, Camera camera = front,
                  std::vector<Mesh> meshes = {}) {
    StressScene scene = authored({std::move(fog)}, {}, camera, std::move(meshes), {lambert(vec3(0))});
    scene.snapshot.environment = std::move(sky);
    return scene;
}

std::shared_ptr<const Environment> half_sky() {
    return sky_of(64, [](vec3 direction) { return vec3(direction.y > 0 ? 1 : 0); });
}

// A uniform sky with a disc that gives `share` of all light.
std::shared_ptr<const Environment> sky_with_sun(float radius, float share, int columns) {
    const float edge = std::cos(radius), steradians = 2 * pi * (1 - edge);
    const float sun = share * 4 * pi / steradians;
    return sky_of(columns,
                  [&](vec3 direction) { return vec3(1 - share + (glm::dot(direction, sunwards) > edge ? sun : 0)); });
}

Medium ball(float extinction, const Phase& phase = {}) {
    return homogeneous_medium(extinction, {vec3(-1), vec3(1)}, phase);
}

StressScene half_lit(double g) { return under(half_sky(), ball(0.2f, forward_phase(static_cast<float>(g)))); }
StressScene in_thick_fog(double depth) { return under(half_sky(), ball(static_cast<float>(depth) / 2)); }
StressScene sun_of(double degrees) {
    return under(sky_with_sun(static_cast<float>(degrees) * pi / 180, 0.9f, 512), ball(0.2f));
}
StressScene with_contrast(double share) {
    return under(sky_with_sun(0.06f, static_cast<float>(share), 512), ball(0.2f, forward_phase(0.6f)));
}

// Walls that leave the front open, and a roof with a hole.
StressScene under_roof(double hole) {
    const float h = 0.5f * static_cast<float>(hole);
    return under(half_sky(), ball(0.2f), front,
                 {box_of({-1.2f, 1.1f, -1.2f}, {-h, 1.2f, 1.2f}, 0), box_of({h, 1.1f, -1.2f}, {1.2f, 1.2f, 1.2f}, 0),
                  box_of({-1.2f, -1.2f, -1.2f}, {-1.1f, 1.2f, 1.2f}, 0),
                  box_of({1.1f, -1.2f, -1.2f}, {1.2f, 1.2f, 1.2f}, 0),
                  box_of({-1.2f, -1.2f, -1.2f}, {1.2f, 1.2f, -1.1f}, 0)});
}

// Seen towards the bright side and away from it.
StressScene seen_from(double azimuth) {
    const float a = static_cast<float>(azimuth) * pi / 180;
    const auto sky = sky_of(64, [](vec3 direction) { return vec3(1 + direction.z); });
    return under(sky, ball(0.2f, forward_phase(0.8f)), camera_from({5 * std::sin(a), 0.3f, 5 * std::cos(a)}, vec3(0)));
}
}

std::vector<StressCase> stress_skies() {
    constexpr std::string_view group = "skies";
    const StressMeasure usual = default_measure();
    return {
        StressCase("half-sky", group, "half a sky, in forward-scattering fog", "g", "", {0, 0.5, 0.9}, Claim::physical,
                   excuses, half_lit, usual),
        StressCase("sky-in-thick-fog", group, "fog under half a sky gets thick", "optical depth", "", {0.1, 1, 10},
                   Claim::physical, excuses, in_thick_fog, usual),
        StressCase("sun-in-map", group, "the sun of a map shrinks to a few texels", "radius", "degrees", {30, 5, 0.5},
                   Claim::physical, excuses, sun_of, usual),
        StressCase("sky-contrast", group, "more and more of the light comes from a sun in the map", "share", "",
                   {0, 0.5, 0.99}, Claim::physical, excuses, with_contrast, usual),
        StressCase("under-roof", group, "a roof whose hole gets small", "hole", "m", {2, 0.6, 0.1}, Claim::physical,
                   excuses, under_roof, usual),
        StressCase("sky-around", group, "the camera goes around fog under a sky that is bright on one side", "azimuth",
                   "degrees", {0, 90, 180}, Claim::physical, excuses, seen_from, usual),
    };
}
}
