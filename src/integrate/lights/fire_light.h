// Light of fog that glows by grids, scattered once towards the eye by other fog. Three ways to pick a point of a ray
// and a place in the fire share it (balance heuristic): places by power with distances even in the angle around them;
// places by power with distances in proportion to what would be seen from there; and from those distances, directions
// by the phase function and places by brightness on them, which is what counts within the fire.
#pragma once
#include "integrate/lights/scatter_paths.h"

#include <memory>

namespace tyndall {
struct EmissiveBricks;

struct FireLight {
    std::shared_ptr<const EmissiveBricks> fire; // null = none
    std::shared_ptr<const Occluders> occluders; // null = nothing shadows it
    ScatteringFog fog;                          // points: on each ray, a third of those asked for
};

// Of a snapshot as the settings see it, with the media that only emit in it.
FireLight fire_light(const Snapshot& snapshot, const StyleSettings& style, const TermSettings& terms,
                     const Camera& camera, bool shadows, float min_transmittance);

// Adds its light along up to 16 rays to their radiance, and to the emission among their parts.
void add_fire_light(const FireLight& light, const RayBatch& batch, std::span<Scatter> results);

// A technique that adds it to what `scatter` finds; `scatter` itself where there is none.
ScatterFunction with_fire_light(FireLight light, ScatterFunction scatter);
}
