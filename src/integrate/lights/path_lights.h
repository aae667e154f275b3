// Monte Carlo single scattering: paths from sampled points on a camera ray to the environment, area lights, fire and
// emissive surfaces.
#pragma once
#include "integrate/lights/fog_points.h"
#include "integrate/ray_batch.h"
#include "integrate/style.h"
#include "volume/medium.h"

#include <functional>
#include <memory>
#include <variant>
#include <vector>

namespace tyndall {
struct Snapshot;
struct TermSettings;
class Occluders;

struct ScatteringFog {
    std::vector<Medium> media;
    std::vector<float> peaks; // peak of each medium's phase function, 1/sr
    StyleSettings style;
    Camera camera;
    float light_depth = 1;       // factor on the optical depth between light and scattering point
    float min_transmittance = 0; // fog behind this transmittance is ignored
    int points = 1;              // sample points per ray and kind of light; some kinds use a multiple
};
std::shared_ptr<const ScatteringFog> scattering_fog(const Snapshot& snapshot, const StyleSettings& style,
                                                    const TermSettings& terms, const Camera& camera,
                                                    float min_transmittance);

// Style fade at a point: the share of scattered light that is kept.
float fade_at(const ScatteringFog& fog, vec3 point);

struct ScatterPath {
    size_t ray = 0;
    Ray shadow_ray{}; // from a point on the camera ray to the light
    vec3 light{0};    // contribution if the shadow ray is unobstructed
};

// A light sampled by random paths.
struct PathLight {
    std::shared_ptr<const Occluders> casters; // null = unshadowed
    std::variant<size_t, OtherLight> part;    // index of a light of the snapshot, or other light
    // Appends the paths of one ray of the batch.
    std::function<void(const RayBatch&, size_t ray, const FogSampler&, std::vector<ScatterPath>&)> append;
};

// Wraps `scatter` to add these lights, attenuated by the surfaces and fog along the paths.
ScatterFunction with_path_lights(std::shared_ptr<const ScatteringFog> fog, std::vector<PathLight> lights,
                                 ScatterFunction scatter);

// Append the environment, emissive surfaces and fire (emission-only media) of a snapshot, if it has any. Each ray
// traces, per sample point, two paths to the environment and to emissive surfaces, and three to fire.
void append_environment_light(const Snapshot& snapshot, std::shared_ptr<const ScatteringFog> fog, bool shadows,
                              std::vector<PathLight>& lights);
void append_mesh_light(const Snapshot& snapshot, std::shared_ptr<const ScatteringFog> fog, bool shadows,
                       std::vector<PathLight>& lights);
void append_fire_light(const Snapshot& snapshot, std::shared_ptr<const ScatteringFog> fog, bool shadows,
                       std::vector<PathLight>& lights);

// Moves the area lights out of the snapshot: four distances per sample point, with up to two paths each.
void take_area_lights(Snapshot& snapshot, std::shared_ptr<const ScatteringFog> fog, bool shadows,
                      std::vector<PathLight>& lights);
}
