#include "render/adaptive/scout.h"

#include "trace/transmittance/light_depth.h"

namespace tyndall {
View uniform_view(View view, int samples, int batches) {
    view.pixel_samples = samples, view.batches = batches;
    view.lamp_samples = view.edge_samples = 1, view.allotted = nullptr;
    return view;
}

std::shared_ptr<const Scout> make_scout(const Mode& mode, const View& view, const Snapshot& snapshot,
                                        const Candidate& candidate, const FrameOptions& options, const Seconds& clock,
                                        std::shared_ptr<const Prepared> prepared) {
    auto scout = std::make_shared<Scout>();
    scout->candidate = candidate, scout->seed = view.seed;
    const View even = uniform_view(view, scout_samples, scout_samples);
    FrameOptions own = options;
    own.progress = {};
    const double start = clock();
    if (!prepared)
        prepared =
            std::make_shared<const Prepared>(prepare_frame(mode, even, snapshot, candidate.settings, options.history));
    scout->prepared = own.prepared = std::move(prepared);
    const double begun = clock();
    scout->layers = render_frame(mode, even, snapshot, candidate.settings, own, scout->stats);
    scout->prepare_seconds = begun - start, scout->seconds = clock() - begun;
    return scout;
}
}
