// Pictures as noisy as wanted and no noisier.
#pragma once
#include "render/frame.h"

namespace tyndall {
inline constexpr int noise_batches = 64;          // of a picture whose noise is measured
inline constexpr int most_target_samples = 65536; // per pixel

// The next number of samples that noise_batches divide.
int batched_samples(int samples);

// Throws Error (usage) unless the mode's error is noise.
void check_target(const Mode& mode);

// Renders rounds of noise_batches batches, each with a seed of its own, until the bound of the noise is at most
// `target` or a pixel has most_target_samples; stats.noise says which. The first round has view.pixel_samples, rounded
// up; later ones what the noise so far asks for, at most as many as all before. Depth is that of the first round.
// How many rounds there are depends on all pixels rendered: a crop may get other bits.
Layers render_to_target(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                        double target, const FrameOptions& options, FrameStats& stats);
}
