// Rendering to a target error, or as accurately as a time limit allows.
#pragma once
#include "render/adaptive/goal.h"

namespace tyndall {
inline constexpr int noise_batches = 64;         // of an image whose noise is measured per pixel
inline constexpr int max_target_samples = 65536; // per pixel

// Rounds up to a multiple of noise_batches.
int batched_samples(int samples);

// Throws Error (usage), naming the option, if the mode's error cannot be measured.
void check_target(const Mode& mode, std::string_view option = "--target-error");

// Renders rounds of samples until the bound of the error is at most goal.error, the next round would end after
// goal.seconds, or pixels have max_target_samples on average; stats.error() is the error reached. Modes with an error
// besides noise use the candidate that choose() picks. The number of rounds depends on all pixels rendered: a crop may
// get other bits. Depth is that of the first round that counts.
//
// At first all pixels take the same number of samples. If that shows that a few need most of them, the image starts
// over with as many as each tile of 4×4 needs (render/adaptive/allotment.h), and again if that shows much that few
// samples had missed; stats.samples is then their mean. pixel.lamp_samples and pixel.edge_samples are ignored.
//
// Noise is measured between batches: 64 in a round if noise is the mode's only error or the view has batches, else two;
// once samples are allotted, 4, 8 and 2 respectively, or more in tiles with many. Each round has its own random
// numbers, except that if many pixels cause the noise of an allotment, its two batches continue from round to round. An
// image of one sample per pixel is judged by the pixels measured beforehand.
//
// If motion blur from the snapshot's moments leaves too little of goal.error and goal.moment_limit allows more, nothing
// is rendered: stats.wanted_moments says how many to try.
Layers render_to_target(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                        Goal goal, const FrameOptions& options, FrameStats& stats);
}
