// Light that fields of grids give off along camera rays, dimmed by the fog before it: at nodes bound to the voxels, so
// that no step or cell of a technique limits it.
#pragma once
#include "integrate/ray_batch.h"
#include "integrate/style.h"
#include "volume/medium.h"

#include <vector>

namespace tyndall {
struct Snapshot;

struct FieldLight {
    std::vector<Medium> fields; // media that only emit
    std::vector<Medium> fog;    // what dims them
    StyleSettings style;
    Camera camera;
    float opaque = 16; // optical depth behind which nothing is asked for
};

// Takes the media that only emit out of a snapshot.
FieldLight take_fields(Snapshot& snapshot, const StyleSettings& style, const Camera& camera);

// Adds the light of the fields along up to 16 rays to their radiance, and to the emission among their parts.
void add_field_light(const FieldLight& light, const RayBatch& batch, std::span<Scatter> results);

// A technique that adds it to what `scatter` finds; `scatter` itself where there are no fields.
ScatterFunction with_field_light(FieldLight light, ScatterFunction scatter);
}
