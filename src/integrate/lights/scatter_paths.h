// Light that fog scatters once towards the eye on single ways: from points of rays to the light.
#pragma once
#include "integrate/ray_batch.h"
#include "integrate/style.h"
#include "volume/medium.h"

#include <vector>

namespace tyndall {
struct Snapshot;
struct TermSettings;
class Occluders;

struct ScatteringFog {
    std::vector<Medium> media;
    StyleSettings style;
    Camera camera;
    float light_depth = 1;       // factor on the optical depth that light crosses on its way to the fog
    float min_transmittance = 0; // behind which fog is not asked for
    int points = 1;              // of which each kind of light asks for on each ray, or a multiple
};
ScatteringFog scattering_fog(const Snapshot& snapshot, const StyleSettings& style, const TermSettings& terms,
                             const Camera& camera, float min_transmittance);

// Whether any of it sends light on.
bool scatters(const ScatteringFog& fog);

// Share of what is scattered at a point that the style shows.
float shown_share(const ScatteringFog& fog, vec3 point);

struct ScatterPath {
    size_t ray = 0;
    Ray way{};     // from a point of it to the light
    vec3 light{0}; // that comes to the eye if nothing is on the way
};

// Adds to the radiance of the rays, and to their part of a number where there are parts, what surfaces (null = none)
// and fog on the ways let through.
void add_scatter_paths(const ScatteringFog& fog, const Occluders* casters, std::span<const ScatterPath> paths,
                       size_t part, const RayBatch& batch, std::span<Scatter> results);
}
