#include "render/frame/noise_fixtures.h"

#include "base/random.h"
#include "modes/mode.h"
#include "modes/settings.h"
#include "trace/view.h"

namespace tyndall::test {
ScatterFunction prepare_random(const View&, const Snapshot&, const Settings&, History*) {
    return [](const RayBatch& batch, std::span<Scatter> results) {
        for (size_t i = 0; i < results.size(); ++i) results[i] = {vec3(to_unit(batch.ids[i])), 1, 1, 1};
    };
}

ScatterFunction prepare_jitter(const View&, const Snapshot&, const Settings&, History*) {
    return [](const RayBatch& batch, std::span<Scatter> results) {
        for (size_t i = 0; i < results.size(); ++i) results[i] = {vec3(batch.jitter[i]), 1, 1, 1};
    };
}

ScatterFunction prepare_place(const View&, const Snapshot&, const Settings&, History*) {
    return [](const RayBatch& batch, std::span<Scatter> results) {
        for (size_t i = 0; i < results.size(); ++i)
            results[i] = {vec3(sample2(batch.sample_indices[i].index, batch.sample_indices[i].sequence).x), 1, 1, 1};
    };
}

Mode own_mode(ScatterFunction (*prepare)(const View&, const Snapshot&, const Settings&, History*)) {
    return {"own",         "shades surfaces itself", "tests", Accuracy::multiple_scattering,
            Surfaces::own, no_limitations,           prepare};
}

View batched_view(ivec2 size, int samples, int batches) {
    View view = plain_view(size, samples, 2.0f);
    view.batches = batches;
    return view;
}

Layers rendered(const Mode& mode, const View& view, const Snapshot& snapshot, FrameOptions options) {
    FrameStats stats;
    return render_frame(mode, view, snapshot, Settings{}, options, stats);
}

double mean_red(const Image<vec3>& image) {
    double sum = 0;
    for (const vec3& value : image.pixels) sum += value.x;
    return sum / static_cast<double>(image.pixels.size());
}
}
