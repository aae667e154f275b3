// Sample counts fixed before a frame is rendered, so that every machine that renders a part of it takes the same; and
// the error of the finished frame.
#pragma once
#include "render/adaptive/errors/planned_error.h"
#include "render/adaptive/goal.h"

namespace tyndall {
struct PlannedSamples {
    Settings settings;                         // of the candidate
    std::shared_ptr<const TileFactors> counts; // samples per pixel of each tile, divided by the groups
    PlannedError error;
    double samples = 0;     // per pixel, on average
    double seconds = 0;     // predicted for a single run on this machine
    int wanted_moments = 0; // that the goal needs, if nothing was planned as the frame has too few
};

// Plans from an image of eight samples per pixel, which is then discarded; the error bound is likely to be at most
// goal.error, which must be above 0. Where the frame has too few moments for that, says how many to try. `view` is the
// frame's, with one batch per group.
PlannedSamples plan_samples(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                            const Goal& goal, const FrameOptions& options);

// The error of a frame that samples do not remove, for settings that were not chosen by a target.
PlannedError systematic_error(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                              const FrameOptions& options);

// Adds to the statistics of a finished image what is known of its error besides noise. With a target error, the
// integrator's is measured again, on tiles where the image shows that errors are likely; independent of what the
// candidate was chosen by, and the same for the same image.
void add_planned_error(const PlannedError& planned, const Mode& mode, const View& view, const Snapshot& snapshot,
                       const Settings& settings, const Layers& image, const FrameOptions& options, FrameStats& stats);

// How many more groups a target needs; 0 if it is reached, infinite if groups cannot reach it.
double missing_groups(const PlannedError& planned, const FrameStats& stats, int groups);
}
