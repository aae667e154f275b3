// Error of motion blur from a frame's moments (time samples) against that of a continuously open shutter: no number of
// samples removes it.
#pragma once
#include "render/adaptive/goal.h"
#include "render/adaptive/pilot.h"

namespace tyndall {
// Traces pixels of randomly drawn tiles through all moments along the same rays, and compares one half of the moments
// with the other, divided so that smooth changes cancel (Prouhet 1851, Thue 1906, Morse 1921). For something visible at
// a single moment the difference is the error; for an edge that passes once it is 2.4 times the error on average. Draws
// more tiles until the error is well known relative to the target `error` (0 = none); only one drawing if `once` or if
// there are many moments. The snapshot must have moments, and `prepared` must be for them.
SquaredError moments_error(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                           const Prepared& prepared, const TileChances& chances, double error, bool once,
                           const FrameOptions& options);

// A larger number of moments if the error of `count` takes up most of the goal's, else 0. It falls at least as 1 / n
// once copies of what moves overlap. A time limit is left to the samples.
int moments_for(const Noise& error, int count, const Goal& goal);
}
