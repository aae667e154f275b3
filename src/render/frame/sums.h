// Sums of a pixel's samples, leaf by leaf and then in the binary tree of part.h. For the files of this folder only.
#pragma once
#include "render/frame/frame_task.h"
#include "render/frame/part.h"
#include "trace/view.h"

namespace tyndall {
// A tile's sums while it is rendered.
struct TileSums {
    const FrameTask& task;
    const PixelTile& tile;
    FrameStats& stats;
    const Layers& layers = task.layers; // only pixels inside it count
    int leaves = task.tracer.view.leaves;
    int sections = task.tracer.view.batches * task.tracer.view.sections; // of all the plan's groups
    int section_size = samples_of(task.tracer.view, tile.corner) / sections;
    std::vector<float> depth = std::vector<float>(16, infinity), off_center = depth;

    size_t stride() const { return fixed_sums + 3 * task.parts.size(); }
};

// The sums of a node, pixel by pixel. Throws Error (internal) when cancelled.
std::vector<float> node_sums(TileSums& tile, const SumNode& node);

// Level of the node that covers a whole section.
int root_level(int leaves);
}
