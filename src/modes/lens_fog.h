// Depth of field for techniques that compute fog from a single eye point: fog is seen through the center of the lens.
#pragma once
#include "integrate/ray_batch.h"
#include "modes/limitation.h"

namespace tyndall {
struct Snapshot;
struct View;

namespace limitation {
inline constexpr LimitationKind fog_through_middle{
    "fog_through_middle",
    "fog lacks a depth-of-field blur of up to {} pixels (at {} m): it is seen through the center of the lens"};
inline constexpr LimitationKind no_fog_picture{"no_fog_picture",
                                               "has no effect: with a lens, fog is computed for every ray"};
}

// Wraps `scatter` to evaluate rays from the center of the lens through the same points in the plane of focus, with the
// same planar depths of start and end. Returns `scatter` itself if the camera has no lens.
ScatterFunction through_middle(const View& view, ScatterFunction scatter);

// Reports the largest circle of confusion among the lamps in the image, the edges of beams and shadows, the near side
// of volumes and the far end of the fog. For techniques that use through_middle().
void add_fog_through_middle(const View& view, const Snapshot& snapshot, Limitations& limitations);

// Reports that the setting `row` has no effect through a lens. For techniques that use a FogBuffer.
void add_no_fog_picture(const View& view, const char* row, Limitations& limitations);
}
