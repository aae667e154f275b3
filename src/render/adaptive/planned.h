// Samples settled before a frame is rendered, so that whoever renders a part of it takes the same; and how good the
// frame is once it is there.
#pragma once
#include "render/adaptive/goal.h"
#include "render/adaptive/planned_error.h"

namespace tyndall {
struct PlannedSamples {
    Settings settings;                         // of the candidate
    std::shared_ptr<const TileFactors> counts; // of samples of every tile, in multiples of the groups
    PlannedError error;
    double samples = 0; // per pixel, on the average
    double seconds = 0; // one run is likely to take here
};

// From a pilot of eight samples per pixel that is thrown away: the bound of the error is likely to be at most
// goal.error, which is above 0. `view` is the frame's, with as many batches as groups are wanted.
PlannedSamples plan_samples(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                            const Goal& goal, const FrameOptions& options);

// What samples do not remove of a frame's error, by settings that no target has chosen.
PlannedError shared_error(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                          const FrameOptions& options);

// Adds to the statistics of a finished image what is known of its error besides noise. Where a target was asked for,
// the integrator's is measured again, on tiles on which the image itself shows that there may be some; independent of
// what the candidate was chosen by, and the same for the same image.
void judge_planned(const PlannedError& planned, const Mode& mode, const View& view, const Snapshot& snapshot,
                   const Settings& settings, const Layers& image, const FrameOptions& options, FrameStats& stats);

// How many groups are lacking to a target; none where it is reached, infinite where groups cannot reach it.
double groups_lacking(const PlannedError& planned, const FrameStats& stats, int groups);
}
