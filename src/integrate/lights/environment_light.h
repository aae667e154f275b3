// Light of the environment that fog scatters once towards the eye. Distances are picked in proportion to what would be
// seen from there; directions both by the light and by the phase function, which share it (balance heuristic).
#pragma once
#include "integrate/lights/scatter_paths.h"

#include <memory>

namespace tyndall {
struct Environment;

struct EnvironmentLight {
    std::shared_ptr<const Environment> environment; // null = none
    std::shared_ptr<const Occluders> occluders;     // null = nothing shadows it
    ScatteringFog fog;
};

// Of a snapshot as the settings see it.
EnvironmentLight environment_light(const Snapshot& snapshot, const StyleSettings& style, const TermSettings& terms,
                                   const Camera& camera, bool shadows, float min_transmittance);

// Adds its light along up to 16 rays to their radiance, and to the ambient light among their parts.
void add_environment_light(const EnvironmentLight& light, const RayBatch& batch, std::span<Scatter> results);

// A technique that adds it to what `scatter` finds; `scatter` itself where there is none.
ScatterFunction with_environment_light(EnvironmentLight light, ScatterFunction scatter);
}
