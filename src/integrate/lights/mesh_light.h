// Light of glowing surfaces that fog scatters once towards the eye. Points of them are picked by area and brightness,
// and distances both evenly in the angle around such a point and in proportion to what would be seen from there, which
// share it (balance heuristic).
#pragma once
#include "integrate/lights/scatter_paths.h"

#include <memory>

namespace tyndall {
struct EmissiveTriangles;

struct MeshLight {
    std::shared_ptr<const EmissiveTriangles> surfaces; // null = none
    std::shared_ptr<const Occluders> occluders;        // which they are of
    bool shadows = true;                               // of all of them
    ScatteringFog fog;                                 // points: on each ray, half of those asked for
};

// Of a snapshot as the settings see it.
MeshLight mesh_light(const Snapshot& snapshot, const StyleSettings& style, const TermSettings& terms,
                     const Camera& camera, bool shadows, float min_transmittance);

// Adds its light along up to 16 rays to their radiance, and to the emission among their parts.
void add_mesh_light(const MeshLight& light, const RayBatch& batch, std::span<Scatter> results);

// A technique that adds it to what `scatter` finds; `scatter` itself where there is none.
ScatterFunction with_mesh_light(MeshLight light, ScatterFunction scatter);
}
