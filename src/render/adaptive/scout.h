// A first picture, quick and coarse: it shows where noise and light are, for the tiles to look at and the samples to
// take. Where the candidate it was made with is the one chosen, it counts.
#pragma once
#include "render/adaptive/candidates.h"
#include "render/adaptive/pilot.h"

namespace tyndall {
inline constexpr int scout_samples = 2; // per pixel, independent of each other

struct Scout {
    const Mode* mode = nullptr;
    Candidate candidate;
    uint32_t seed = 0;
    Layers layers;
    FrameStats stats;
    std::shared_ptr<const Prepared> prepared;
    double prepare_seconds = 0, seconds = 0; // the latter without preparing

    double work() const { return ray_work * static_cast<double>(stats.camera_rays) + static_cast<double>(stats.steps); }
};

// `prepared` for that candidate, where it is already.
std::shared_ptr<const Scout> make_scout(const Mode& mode, const View& view, const Snapshot& snapshot,
                                        const Candidate& candidate, const FrameOptions& options, const Seconds& clock,
                                        std::shared_ptr<const Prepared> prepared = {});

// The view of a picture that is measured: lamps and edges take no more samples than other pixels.
View even_view(View view, int samples, int batches);
}
