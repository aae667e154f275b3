// Modes whose noise is known by construction, and what to hold it against.
#pragma once
#include "fixtures.h"

#include <cmath>
#include <cstring>

namespace tyndall::test {
// Every sample is a grey of its own, even in [0,1): mean 1/2, variance 1/12.
inline ScatterFunction prepare_random(const View&, const Snapshot&, const Settings&, History*) {
    return [](const RayBatch& batch, std::span<Scatter> results) {
        for (size_t i = 0; i < results.size(); ++i) results[i] = {vec3(to_unit(batch.ids[i])), 1, 1, 1};
    };
}
inline constexpr double random_mean = 0.5, random_variance = 1.0 / 12;

inline Mode own_mode(ScatterFunction (*prepare)(const View&, const Snapshot&, const Settings&, History*)) {
    return {"own", "shades surfaces itself", Accuracy::multiple_scattering, Surfaces::own, no_limits, prepare};
}

inline View batched_view(ivec2 size, int samples, int batches) {
    View view = plain_view(size, samples, 2.0f);
    view.batches = batches;
    return view;
}

template<class T> bool same_bits(const Image<T>& a, const Image<T>& b) {
    return a.size == b.size && std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(T)) == 0;
}

template<class T> Image<T> cut(const Image<T>& image, ivec2 low, ivec2 high) {
    Image<T> result(high - low);
    for (int y = low.y; y < high.y; ++y)
        for (int x = low.x; x < high.x; ++x) result.at(x - low.x, y - low.y) = image.at(x, y);
    return result;
}

inline Layers rendered(const Mode& mode, const View& view, const Snapshot& snapshot, FrameOptions options = {}) {
    FrameStats stats;
    return render_frame(mode, view, snapshot, Settings{}, options, stats);
}

inline double mean_red(const Image<vec3>& image) {
    double sum = 0;
    for (const vec3& value : image.pixels) sum += value.x;
    return sum / static_cast<double>(image.pixels.size());
}
}
