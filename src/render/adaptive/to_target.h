// Pictures as right as wanted and no better, or as good as a time allows.
#pragma once
#include "render/adaptive/goal.h"

namespace tyndall {
inline constexpr int noise_batches = 64;         // of a picture whose noise is measured pixel by pixel
inline constexpr int max_target_samples = 65536; // per pixel

// The next number of samples that noise_batches divide.
int batched_samples(int samples);

// Throws Error (usage) in the name of an option unless the mode's error can be told.
void check_target(const Mode& mode, std::string_view option = "--target-error");

// Renders rounds of samples until the bound of the error is at most goal.error, the next round would end after
// goal.seconds, or pixels have max_target_samples on the average; stats.error() says how good it is. Modes with an
// error besides noise are set to the candidate that choose() picks. How many rounds there are depends on all pixels
// rendered: a crop may get other bits. Depth is that of the first round that counts.
//
// First all pixels take equally many samples. Where that shows that a few need most of them, the picture is begun anew
// with as many as each tile of 4×4 needs (render/adaptive/allotment.h), again where that shows much that few samples
// had missed, and stats.samples is their mean; pixel.lamp_samples and pixel.edge_samples decide nothing.
//
// Noise is measured between batches: 64 in a round where noise is the mode's only error or the view has batches, else
// two; once samples are allotted 4, 8 and 2 in the same cases, or more in tiles of many. Each round has random numbers
// of its own, but where many pixels hold the noise of an allotment its two batches go on from round to round. A picture
// of one sample per pixel is judged by the pixels measured beforehand.
Layers render_to_target(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                        Goal goal, const FrameOptions& options, FrameStats& stats);
}
