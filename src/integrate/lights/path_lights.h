// Lights that rays look for themselves, of fog that scatters once: from points of a ray ways are picked at random to
// skies, faces, fire and surfaces that glow.
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
    std::vector<float> peaks; // the largest value of each one's phase function, straight on or back, 1/sr
    StyleSettings style;
    Camera camera;
    float light_depth = 1;       // factor on the optical depth that light crosses on its way to the fog
    float min_transmittance = 0; // behind which fog is not asked for
    int points = 1;              // of which each kind of light asks for on each ray, or a multiple
};
std::shared_ptr<const ScatteringFog> scattering_fog(const Snapshot& snapshot, const StyleSettings& style,
                                                    const TermSettings& terms, const Camera& camera,
                                                    float min_transmittance);

// Share of what is scattered at a point that the style shows.
float shown_share(const ScatteringFog& fog, vec3 point);

struct ScatterPath {
    size_t ray = 0;
    Ray way{};     // from a point of it to the light
    vec3 light{0}; // that comes to the eye if nothing is on the way
};

// A light that rays look for themselves, by ways that are picked at random.
struct PathLight {
    std::shared_ptr<const Occluders> casters; // null = nothing shadows it
    std::variant<size_t, OtherLight> part;    // of the light in fog: that of a light of the snapshot, or of other light
    // Appends the ways of a ray of the batch through its fog.
    std::function<void(const RayBatch&, size_t ray, const SeenFog&, std::vector<ScatterPath>&)> append;
};

// A technique that adds them to what `scatter` finds, as far as surfaces and fog on the ways let them through.
ScatterFunction with_path_lights(std::shared_ptr<const ScatteringFog> fog, std::vector<PathLight> lights,
                                 ScatterFunction scatter);

// Append the lights of a snapshot as the settings see it; nothing where it has none. A ray looks along two ways for
// each of its points to the environment and to surfaces that glow, along three to fire (of the media that only emit).
void append_environment_light(const Snapshot& snapshot, std::shared_ptr<const ScatteringFog> fog, bool shadows,
                              std::vector<PathLight>& lights);
void append_mesh_light(const Snapshot& snapshot, std::shared_ptr<const ScatteringFog> fog, bool shadows,
                       std::vector<PathLight>& lights);
void append_fire_light(const Snapshot& snapshot, std::shared_ptr<const ScatteringFog> fog, bool shadows,
                       std::vector<PathLight>& lights);

// Takes the lights with a face out of the snapshot: from four places, two ways each.
void take_faces(Snapshot& snapshot, std::shared_ptr<const ScatteringFog> fog, bool shadows,
                std::vector<PathLight>& lights);
}
