// How far motion blur of a frame's moments is from that of all the time the shutter is open: no number of samples
// removes it.
#pragma once
#include "render/adaptive/pilot.h"

namespace tyndall {
// By pixels of tiles that are drawn, each followed through all moments along the same rays. What half of the moments
// show is set against what the other half does, chosen so that what changes evenly cancels (Prouhet 1851, Thue 1906,
// Morse 1921). Of something that is seen in one moment alone that is the error; of an edge that passes once it is 2.4
// times as much, on the average. More tiles are drawn until that is known well beside the `error` asked for (0 = none
// is), or for one drawing `once` or where there are many moments. The snapshot has moments, and `prepared` is for them.
SquaredError moments_error(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                           const Prepared& prepared, const TileChances& chances, double error, bool once,
                           const FrameOptions& options);
}
