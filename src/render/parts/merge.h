// EXR parts put together into the frame that one run of their plan renders.
#pragma once
#include "render/parts/part_file.h"
#include "render/parts/plan_file.h"

#include <span>
#include <vector>

namespace tyndall {
struct Scene;

// Sorts the parts of a frame by the samples they hold. Throws Error (refused), naming a file, unless all are of one
// frame and plan, and hold every sample of whole groups, the plan's at least, exactly once. Returns how many groups.
int check_parts(std::vector<PartFile>& parts, const SavedPlan& plan);

// The frame, with its error. Throws Error (refused) where fog or scene are not what the parts were rendered from.
struct MergedFrame {
    Layers layers;
    FrameStats stats;
    Provenance provenance;
};
MergedFrame merge_frame(std::vector<PartFile> parts, int groups, const Scene& scene, const SavedPlan& plan);
}
