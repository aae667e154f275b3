// How far off it is to replace an environment's light in fog by its unshadowed mean.
#pragma once

namespace tyndall {
struct Snapshot;
struct View;

// Relative RMS error (rmse_rel) over 8×6 camera rays, or those of a finer grid where few of them meet fog; 0 if none
// does.
double mean_environment_error(const View& view, const Snapshot& snapshot);
}
