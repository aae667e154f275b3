// Where a picture changes so much from pixel to pixel that more rays are worth their time: found by one ray through the
// centre of each pixel, which does not count for the picture, so that what is found does not bias it.
#pragma once
#include "render/frame/frame_task.h"

namespace tyndall {
struct TileFactors;

// How many times as many samples the tiles around the task's part of the picture take, 1 to view.edge_samples; null
// where all take one times: that many are allowed, pixels are seen at their centres only, or have too few samples to
// gain by it. Counts the rays in `stats`. A tile's number depends on its own pixels and those beside it. Of a prepared
// plan they come from a file.
std::shared_ptr<const TileFactors> edge_factors(const FrameTask& task, FrameStats& stats);
}
