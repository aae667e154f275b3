// The glow around suns in fog with phase lobes narrower than froxels: lobes are widened to the mean over a froxel, as
// the value at a froxel's center would fill all of it.
#pragma once
#include "volume/medium.h"

namespace tyndall {
struct Light;
struct Snapshot;
struct View;

// Angle from the light, radians, within which a phase function exceeds half its forward peak: 0.77 (1 - g) for g near
// 1.
float glow_angle(const Phase& phase);

// Whether froxels of angular width `across` are too coarse for a phase function. With several lobes, the narrowest
// counts, and needs three froxels.
inline bool is_narrow(const Phase& phase, float across) { return glow_angle(phase) < (phase.shape ? 3 : 1) * across; }

// Angular width of a froxel at the image's center, radians; 0 with an orthographic camera.
float tile_angle(const View& view, int tile);

// Whether a light is a sun within the image.
bool shows_sun(const View& view, const Snapshot& snapshot, const Light& light);

// The media with narrow phase functions widened to froxels; empty if there are none, or if froxels are pixels.
std::vector<Medium> media_in_sunlight(const View& view, const Snapshot& snapshot, int tile);
}
