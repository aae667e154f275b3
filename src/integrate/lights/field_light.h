// Direct emission of grid fields along camera rays, attenuated by the fog in front. Nodes follow the voxels, so the
// resolution does not depend on the step size or cells of a technique.
#pragma once
#include "integrate/ray_batch.h"
#include "integrate/style.h"
#include "volume/medium.h"

#include <vector>

namespace tyndall {
struct Snapshot;

struct FieldLight {
    std::vector<Medium> fields; // emission-only media
    std::vector<Medium> fog;    // media that attenuate them
    StyleSettings style;
    Camera camera;
    float opaque = 16; // optical depth beyond which nodes are skipped
};

// Moves the emission-only media out of a snapshot.
FieldLight take_fields(Snapshot& snapshot, const StyleSettings& style, const Camera& camera);

// Adds the emission of the fields along up to 16 rays to their radiance, and to their emission part.
void add_field_light(const FieldLight& light, const RayBatch& batch, std::span<Scatter> results);

// Wraps `scatter` to add field emission; returns `scatter` unchanged if there are no fields.
ScatterFunction with_field_light(FieldLight light, ScatterFunction scatter);
}
