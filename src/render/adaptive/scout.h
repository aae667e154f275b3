// A quick, coarse first image of a quarter of the pixels: it shows where noise and light are, to draw tiles and allot
// samples. It is then discarded.
#pragma once
#include "render/adaptive/candidates.h"
#include "render/adaptive/pilot.h"

namespace tyndall {
inline constexpr int scout_samples = 2; // per pixel, independent of each other

struct Scout {
    Candidate candidate;
    Layers layers; // each traced pixel stands for four
    FrameStats stats;
    std::shared_ptr<const Prepared> prepared;
    double prepare_seconds = 0, sample_seconds = 0; // the latter per sample of all the image's pixels

    double ray_cost() const {
        return ray_work + static_cast<double>(stats.steps) / static_cast<double>(stats.camera_rays);
    }
};

// `prepared`: for that candidate, if it exists already.
std::shared_ptr<const Scout> make_scout(const Mode& mode, const View& view, const Snapshot& snapshot,
                                        const Candidate& candidate, const FrameOptions& options, const Seconds& clock,
                                        std::shared_ptr<const Prepared> prepared = {});

// The view with the same number of samples in all pixels, also around lamps and at edges.
View uniform_view(View view, int samples, int batches);
}
