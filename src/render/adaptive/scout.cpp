#include "render/adaptive/scout.h"

#include "trace/transmittance/light_depth.h"

namespace tyndall {
namespace {
// Both samples of a pixel may miss an edge that lies between it and the next pixel traced, two pixels away: raises the
// variance of their mean to a tenth of that of the mean of two samples that fall on either side.
void note_edges(const Image<vec3>& picture, Image<vec3>& variances) {
    constexpr float share = 0.1f;
    constexpr ivec2 beside[] = {{2, 0}, {0, 2}, {-2, 0}, {0, -2}};
    for (int y = 0; y < picture.size.y; ++y)
        for (int x = 0; x < picture.size.x; ++x) {
            vec3 sum(0);
            for (const ivec2 step : beside) {
                const ivec2 p = glm::clamp(ivec2(x, y) + step, ivec2(0), picture.size - 1);
                const vec3 difference = picture.at(x, y) - picture.at(p.x, p.y);
                sum += difference * difference / 4.0f;
            }
            variances.at(x, y) = glm::max(variances.at(x, y), share * sum / 4.0f);
        }
}
}

View uniform_view(View view, int samples, int batches) {
    view.pixel_samples = samples, view.batches = batches;
    view.lamp_samples = view.edge_samples = 1, view.allotted = nullptr;
    return view;
}

std::shared_ptr<const Scout> make_scout(const Mode& mode, const View& view, const Snapshot& snapshot,
                                        const Candidate& candidate, const FrameOptions& options, const Seconds& clock,
                                        std::shared_ptr<const Prepared> prepared) {
    auto scout = std::make_shared<Scout>();
    scout->candidate = candidate;
    View even = uniform_view(view, scout_samples, scout_samples);
    even.sparse = true;
    FrameOptions own = options;
    own.progress = {};
    const double start = clock();
    if (!prepared)
        prepared =
            std::make_shared<const Prepared>(prepare_frame(mode, even, snapshot, candidate.settings, options.history));
    scout->prepared = own.prepared = std::move(prepared);
    const double begun = clock();
    scout->layers = render_frame(mode, even, snapshot, candidate.settings, own, scout->stats);
    note_edges(scout->layers.color, scout->layers.variance);
    note_edges(scout->layers.inscatter, scout->layers.inscatter_variance);
    scout->prepare_seconds = begun - start;
    const double pixels = static_cast<double>(scout->layers.size.x) * scout->layers.size.y;
    scout->sample_seconds = (clock() - begun) * pixels / static_cast<double>(scout->stats.camera_rays);
    return scout;
}
}
