// Fog between the frames of its files: moved along its velocities, or mixed from two frames.
#pragma once
#include "volume/bricks/sparse_volume.h"
#include "volume/emission/luminance.h"

#include <string>

namespace tyndall {
struct VelocityField;

// Fog as it is a time later, earlier where that is below 0, on voxels of the same size. Each piece goes on along a
// straight line at the velocity that it has, v(y): at x is now what was at y = x - v(y)·time, found by fixed-point
// iteration from v(x). That is the look-up of Eulerian motion blur (Kim and Ko 2007), which Arnold, Karma and Cycles do
// as well; Cycles iterates it once. Where no velocity is known, fog stands still. Values move along and are not
// thinned where fog spreads. `what` is named in errors. Throws Error: refused, where it would move by thousands of
// voxels; out_of_memory.
SparseVolume moved_fog(const PlacedBricks& fog, const VelocityField& velocity, double time, const std::string& what);

// (1 - share)·a + share·b on the finer of their voxels, a's where they are alike. Either may have no bricks. Throws
// Error (out_of_memory).
SparseVolume blended_fog(const PlacedBricks& a, const PlacedBricks& b, float share, const std::string& what);
}
