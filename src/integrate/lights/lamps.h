// Lamps in place of emissive fog and emissive surfaces, for techniques that support only lamps.
#pragma once
#include "integrate/ray_batch.h"
#include "integrate/style.h"
#include "integrate/terms.h"

namespace tyndall {
// For all fire, and for all emissive surfaces.
inline constexpr size_t max_lamps = 4;

// Radius of a ball with this mean squared distance to its center per axis.
float ball_radius(dvec3 spread);

// The snapshot with a style and terms applied, the environment as ambient light, and lamps appended to its lights.
Snapshot with_lamps(const Snapshot& snapshot, const StyleSettings& style, const TermSettings& terms);

// Wraps `scatter` for such a snapshot of `all` lights so that the parts of lamps count as emission. `lights`: number of
// lights in the scene.
ScatterFunction with_lamps_as_emission(size_t lights, size_t all, ScatterFunction scatter);
}
