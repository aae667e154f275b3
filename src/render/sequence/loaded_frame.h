// A frame of a sequence, loaded to be looked at before it is rendered.
#pragma once
#include "trace/snapshot.h"

namespace tyndall {
struct RenderRequest;

struct LoadedFrame {
    Snapshot snapshot;
    double seconds = 0; // it took
};

// Loads the first frame asked for, to look at it before the others. What stands still is shared with `previous`, when
// that is a frame of the same scene. Throws Error.
LoadedFrame load_first_frame(const Scene& scene, const RenderRequest& request, const Snapshot* previous = nullptr);
}
