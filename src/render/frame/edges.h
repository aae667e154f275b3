// Finds where the image changes so much from pixel to pixel that more samples pay off: by one ray through the center of
// each pixel, which is not part of the image, so that the choice does not bias it.
#pragma once
#include "render/frame/frame_task.h"

namespace tyndall {
struct TileFactors;

// Sample factors, 1 to view.edge_samples, of the tiles around the task's part of the image; null if all are 1: the view
// allows no more, or allots samples, or pixels are sampled at their centers only or have too few samples to benefit.
// Counts the rays in `stats`. A tile's factor depends on its own pixels and those next to it. For a prepared plan, the
// factors come from a file.
std::shared_ptr<const TileFactors> edge_factors(const FrameTask& task, FrameStats& stats);
}
