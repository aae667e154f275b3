// Light of rectangles, discs and balls that fog scatters once towards the eye. Distances are picked both evenly in the
// angle around the light and in proportion to what would be seen from there, which share it (balance heuristic); points
// of the face by its solid angle.
#pragma once
#include "integrate/lights/scatter_paths.h"
#include "scene/light.h"

#include <memory>
#include <vector>

namespace tyndall {
struct FaceLight {
    std::vector<Light> lights;
    std::vector<std::shared_ptr<const Occluders>> casters; // of each; null = nothing shadows it
    size_t first = 0;                                      // its number among the lights of the snapshot
    ScatteringFog fog; // points: on each ray, for each light, a quarter of those asked for
};

// Takes the lights that are faces out of a snapshot as the settings see it.
FaceLight take_faces(Snapshot& snapshot, const StyleSettings& style, const TermSettings& terms, const Camera& camera,
                     bool shadows, float min_transmittance);

// Adds their light along up to 16 rays to the radiance and to their own parts.
void add_face_light(const FaceLight& faces, const RayBatch& batch, std::span<Scatter> results);

// A technique that adds it to what `scatter` finds; `scatter` itself where there is none.
ScatterFunction with_face_light(FaceLight faces, ScatterFunction scatter);
}
