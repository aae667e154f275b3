// Merges EXR parts into the frame that a single run of their plan renders.
#pragma once
#include "render/parts/part_file.h"
#include "render/parts/plan_file.h"

#include <span>
#include <vector>

namespace tyndall {
struct Scene;

// Which groups the parts of a frame hold.
struct PartGroups {
    int groups = 0;                 // from the first on
    double share = 1;               // of their samples that the parts hold
    std::string gap{};              // description of the first missing part; empty = none
    std::filesystem::path beside{}; // the part next to it
};

// Sorts the parts of a frame by their samples and finds the groups they cover: whole groups, at least the plan's.
// Throws Error (refused), naming a file, if they are not of one frame and plan or if two hold the same sample.
PartGroups check_parts(std::vector<PartFile>& parts, const SavedPlan& plan);

// The merged frame, with its error if that is known. Throws Error (refused) if fog or scene have changed since the
// parts were rendered.
struct MergedFrame {
    Layers layers;
    FrameStats stats;
    Provenance provenance;
    int64_t empty_pixels = 0;
};
MergedFrame merge_frame(std::span<const PartFile> parts, const PartGroups& groups, const Scene& scene,
                        const SavedPlan& plan);
}
