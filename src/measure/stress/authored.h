// What scenes are authored with beside lamps and fog: flames, faces, skies, an open shutter. Internal to stress.
#pragma once
#include "measure/stress/trial.h"
#include "scene/area_shape.h"
#include "scene/scene.h"
#include "trace/lights/environment.h"

#include <functional>

namespace tyndall {
// Where light is found by chance, fewer pixels do: of the shape of stress_size.
constexpr ivec2 authored_size{40, 24};

// Against the truth, what techniques are asked for whatever a scene has: an error of 10 %, a bias of 2 %.
inline constexpr std::string_view with_bias = "relative RMSE of image or fog light; bias of the fog's mean light";
StressMeasure usual_measure();

Medium thin_haze(float extinction = 0.1f, const Phase& phase = {});

// A flame on a base, with its smoke.
struct Flame {
    vec3 base{0};
    float height = 1, core = 1900, edge = 1100; // metres, kelvin
    float smoke = 1;                            // extinction, 1/m
    BlackbodyKind kind = BlackbodyKind::kelvin;
};
std::vector<Medium> burning(const Flame& flame);

// Of 1 nit; half its width and height, or the radius twice. The lights with a face come after all others.
Light face_light(LightKind kind, vec3 center, vec3 normal, vec2 half);

// A map of directions, as wide as `columns` texels, of what a function gives for their middles.
std::shared_ptr<const Environment> sky_of(int columns, const std::function<vec3(vec3 direction)>& radiance);

// A scene of that shutter, in seconds that are frames; its truth is of 64 moments.
StressScene shuttered(Scene scene, double open, double close);

// Fog, lights, surfaces and camera of a stress scene, as many pixels as where light is found by chance.
StressScene authored(std::vector<Medium> media, std::vector<Light> lights, Camera camera, std::vector<Mesh> meshes = {},
                     std::vector<Material> materials = {});

// Fog as a scene file has it, with what each channel meets.
void use_media(const std::vector<MediumSource>& media, StressScene& scene);
}
