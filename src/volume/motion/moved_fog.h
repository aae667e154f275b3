// Fog between the frames of its file sequence: advected along its velocities, or blended from two frames.
#pragma once
#include "volume/bricks/sparse_volume.h"
#include "volume/emission/luminance.h"

#include <string>

namespace tyndall {
struct VelocityField;

// Fog advected by `time` (may be negative) on voxels of the same size. Fog moves in straight lines: the value at x is
// looked up at y = x - v(y)·time, found by fixed-point iteration starting from v(x). This is the lookup of Eulerian
// motion blur (Kim and Ko 2007), as in Arnold, Karma and Cycles; Cycles iterates once. Fog without a known velocity
// stays in place. Densities are not rescaled where the flow diverges. `what` names the fog in errors. Throws Error:
// refused if it would move by thousands of voxels; out_of_memory.
SparseVolume moved_fog(const PlacedBricks& fog, const VelocityField& velocity, double time, const std::string& what);

// (1 - share)·a + share·b, in a's unit if it has bricks, on the finer of the two voxel grids, or on a's if they are
// equally fine. Either may have no bricks. Throws Error (refused, out_of_memory).
SparseVolume blended_fog(const PlacedBricks& a, const PlacedBricks& b, float share, const std::string& what);
}
