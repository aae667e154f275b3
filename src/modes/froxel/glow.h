// Glows of suns in fog whose lobes are narrower than froxels: froxels hold their mean, as what they are at a froxel's
// middle would fill all of it.
#pragma once
#include "volume/medium.h"

namespace tyndall {
struct Light;
struct Snapshot;
struct View;

// Radians from a light within which a phase function is more than half of what it is straight on: 0.77 (1 - g), for g
// near 1.
float glow_angle(const Phase& phase);

// Whether froxels of an angle across are too coarse for it. Narrow lobes of several stand on a wide rest, and are told
// by their peak: they need three froxels.
inline bool is_narrow(const Phase& phase, float across) { return glow_angle(phase) < (phase.shape ? 3 : 1) * across; }

// Angle across a froxel in the middle of the image; 0 where rays are parallel, and where froxels are as small as
// pixels.
float tile_angle(const View& view, int tile);

// Whether a light is a sun that stands in the image.
bool shows_sun(const View& view, const Snapshot& snapshot, const Light& light);

// The media with such phase functions widened to froxels; empty where there is no need.
std::vector<Medium> media_in_sunlight(const View& view, const Snapshot& snapshot, int tile);
}
