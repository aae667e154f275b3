// Rectangle, disc and sphere lights in fog: huge, edge on, next to the eye, half hidden.
#include "measure/stress/authored.h"
#include "modes/area_light_limitations.h"
#include "modes/froxel/limitations.h"
#include "modes/light_filters.h"
#include "modes/shadow_map/limitations.h"
#include "modes/shadow_volume/limitations.h"
#include "modes/shared_limitations.h"
#include "scene/light.h"
#include "scene/mesh.h"
#include "volume/bricks/sparse_volume.h"
#include "volume/medium.h"
#include "volume/phase.h"

namespace tyndall {
namespace {
const std::vector<Excuse> excuses{{&limitation::lamp_for_face},
                                  {&limitation::hard_shadows},
                                  {&limitation::coarse_shafts},
                                  {&limitation::grainy_edges},
                                  shadows_ignored,
                                  {&limitation::few_steps_for_glow},
                                  {&limitation::deep_steps},
                                  {&limitation::deep_froxels}};
const Camera beside = camera_from({0, 0.2f, 5}, {0, 0.2f, 0});

StressScene lit_by(Light face, Camera camera = beside, Medium haze = thin_haze(), std::vector<Mesh> meshes = {}) {
    return authored({std::move(haze)}, {std::move(face)}, camera, std::move(meshes), {lambert(vec3(0))});
}

// Shines down from 1.5 m.
Light above(LightKind kind, double half) {
    return face_light(kind, {0, 1.5f, 0}, {0.2f, -1, 0.1f}, vec2(static_cast<float>(half)));
}
StressScene rectangle_of(double half) { return lit_by(above(LightKind::rectangle, half)); }
StressScene disc_of(double radius) { return lit_by(above(LightKind::disc, radius)); }
StressScene ball_of(double radius) { return lit_by(above(LightKind::sphere, radius)); }
StressScene strip_of(double half) {
    Light light = face_light(LightKind::rectangle, {0, 1.2f, 0}, {0, -1, 0},
                             {static_cast<float>(half), 0.04f / static_cast<float>(half)});
    return lit_by(std::move(light));
}

// Its plane turns until the eye lies in it.
StressScene edge_on(double degrees) {
    const float a = static_cast<float>(degrees) * pi / 180;
    return lit_by(face_light(LightKind::rectangle, vec3(0), {0, std::cos(a), std::sin(a)}, vec2(0.6f)));
}

// The fog begins `gap` below the light; a negative gap puts the light into the fog.
StressScene over_fog(double gap) {
    const Box box{vec3(-2, -2, -2), vec3(2, 0.8f - static_cast<float>(gap), 2)};
    return lit_by(face_light(LightKind::rectangle, {0, 0.8f, 0}, {0, -1, 0}, vec2(0.5f)), beside,
                  homogeneous_medium(0.3f, box));
}

StressScene eye_in_glow(double distance) {
    return lit_by(face_light(LightKind::disc, vec3(0), {0, 0, 1}, vec2(0.4f)),
                  camera_from({0.1f, 0.1f, static_cast<float>(distance)}, {1, 0.3f, 1.5f}));
}

StressScene in_fog(double extinction) {
    return lit_by(above(LightKind::disc, 0.3), beside, thin_haze(static_cast<float>(extinction)));
}

// A plate below it, with a penumbra all around.
StressScene over_plate(double half) {
    return lit_by(face_light(LightKind::rectangle, {0, 1.5f, 0}, {0, -1, 0}, vec2(static_cast<float>(half))), beside,
                  thin_haze(), {box_of({-0.5f, 0.4f, -0.5f}, {0.5f, 0.45f, 0.5f}, 0)});
}

StressScene forward_fog(double g) {
    return lit_by(above(LightKind::rectangle, 0.3), beside, thin_haze(0.1f, forward_phase(static_cast<float>(g))));
}
}

std::vector<StressCase> stress_faces() {
    constexpr std::string_view group = "area lights";
    const StressMeasure usual = default_measure();
    return {
        StressCase("rectangle", group, "a rectangle gets huge", "half a side", "m", {0.05, 0.3, 2}, Claim::physical,
                   excuses, rectangle_of, usual),
        StressCase("disc", group, "a disc gets huge", "radius", "m", {0.05, 0.3, 2}, Claim::physical, excuses, disc_of,
                   usual),
        StressCase("ball", group, "a ball gets huge", "radius", "m", {0.05, 0.3, 1}, Claim::physical, excuses, ball_of,
                   usual),
        StressCase("strip", group, "a rectangle gets long and thin", "half its length", "m", {0.2, 1, 3},
                   Claim::physical, excuses, strip_of, usual),
        StressCase("edge-on", group, "a rectangle turns until it is seen edge on", "plane to view", "degrees",
                   {90, 20, 2, 0}, Claim::physical, excuses, edge_on, usual),
        StressCase("face-over-fog", group, "a rectangle comes down to the fog, and into it", "gap", "m",
                   {1, 0.1, 0, -0.3}, Claim::physical, excuses, over_fog, usual),
        StressCase("eye-at-disc", group, "the camera comes near a disc", "distance", "m", {2, 0.5, 0.05},
                   Claim::physical, excuses, eye_in_glow, usual),
        StressCase("disc-in-fog", group, "the fog around a disc gets thick", "extinction", "1/m", {0.02, 0.3, 1},
                   Claim::physical, excuses, in_fog, usual),
        StressCase("half-shadow", group, "a rectangle over a plate: the penumbra gets wide", "half a side", "m",
                   {0.02, 0.2, 0.8}, Claim::physical, excuses, over_plate, usual),
        StressCase("face-in-droplets", group, "a rectangle in forward-scattering fog", "g", "", {0, 0.6, 0.9},
                   Claim::physical, excuses, forward_fog, usual),
    };
}
}
