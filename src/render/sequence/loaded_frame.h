// A frame of a job, loaded to be looked at before it is rendered.
#pragma once
#include "trace/snapshot.h"

namespace tyndall {
struct RenderJob;

struct LoadedFrame {
    Snapshot snapshot;
    double seconds = 0; // it took
};

// Loads a job's first frame, to look at it before the others. What stands still is shared with `previous`, when that
// is a frame of the same scene. Throws Error.
LoadedFrame load_first_frame(const Scene& scene, const RenderJob& job, const Snapshot* previous = nullptr);
}
