// EXR parts put together into the frame that one run of their plan renders.
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
    double share = 1;               // of their samples
    std::string gap{};              // where a part is missing, if one is
    std::filesystem::path beside{}; // the part next to it
};

// Sorts the parts of a frame by the samples they hold, of whole groups, the plan's at least. Throws Error (refused),
// naming a file, where they are not of one frame and plan or hold a sample twice.
PartGroups check_parts(std::vector<PartFile>& parts, const SavedPlan& plan);

// The frame, with its error where that is known. Throws Error (refused) where fog or scene are not what the parts were
// rendered from.
struct MergedFrame {
    Layers layers;
    FrameStats stats;
    Provenance provenance;
    int64_t empty_pixels = 0;
};
MergedFrame merge_frame(std::span<const PartFile> parts, const PartGroups& groups, const Scene& scene,
                        const SavedPlan& plan);
}
