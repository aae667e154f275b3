// Parts of scenes beyond lamps and fog: flames, area lights, skies, an open shutter. Internal to stress.
#pragma once
#include "measure/stress/trial.h"
#include "scene/lights/area_shape.h"
#include "scene/scene.h"
#include "trace/lights/environment.h"

#include <functional>

namespace tyndall {
// Image size where light is randomly sampled: fewer pixels, about the aspect ratio of stress_size.
constexpr ivec2 authored_size{40, 24};

// Against the ground truth, the same for every scene: an error of 10 % and a bias of 2 % are allowed.
inline constexpr std::string_view with_bias = "relative RMSE of image or fog light; bias of the fog's mean light";
StressMeasure default_measure();

Medium thin_haze(float extinction = 0.1f, const Phase& phase = {});

// A flame on a base, with its smoke.
struct Flame {
    vec3 base{0};
    float height = 1, core = 1900, edge = 1100; // meters, kelvin
    float smoke = 1;                            // extinction, 1/m
    BlackbodyKind kind = BlackbodyKind::kelvin;
};
std::vector<Medium> burning(const Flame& flame);

// An area light of 1 nit; `half`: half its width and height, or its radius twice. Area lights come after all others.
Light face_light(LightKind kind, vec3 center, vec3 normal, vec2 half);

// A latitude-longitude map, `columns` texels wide, of the radiance at texel centers.
std::shared_ptr<const Environment> sky_of(int columns, const std::function<vec3(vec3 direction)>& radiance);

// A scene with that shutter, in frames of one second; its ground truth is rendered at 64 moments.
StressScene shuttered(Scene scene, double open, double close);

// A stress scene rendered at authored_size.
StressScene authored(std::vector<Medium> media, std::vector<Light> lights, Camera camera, std::vector<Mesh> meshes = {},
                     std::vector<Material> materials = {});

// Sets a scene's fog as a scene file does, extinction per channel included.
void use_media(const std::vector<MediumSource>& media, StressScene& scene);
}
