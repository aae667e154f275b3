// Pictures of tiny scenes by the froxel mode and by the reference.
#pragma once
#include "scene/camera.h"
#include "stage.h"

namespace tyndall::test {
// A box of fog of which a roof shadows half from a slanted sun.
inline Stage half_shadowed_fog() {
    return stage_of({even_fog(0.3f, {vec3(-3, 0, -3), vec3(3, 3, 3)})}, {sun({0.3f, -1, 0.1f}, 2)},
                    {quad({-50, 4, -50}, {50.2f, 0, 0}, {0, 0, 100})});
}

inline View view_of(vec3 position, vec3 target, ivec2 size = {64, 36}) {
    View view;
    view.camera = look_at(position, target, {0, 1, 0}, 0.8f);
    view.size = size;
    return view;
}

// One ray through the centre of every pixel, up to the first surface or `far`.
inline std::vector<Ray> picture_rays(const View& view, const Snapshot& snapshot, float far = 1000) {
    std::vector<Ray> rays;
    for (int y = 0; y < view.size.y; ++y)
        for (int x = 0; x < view.size.x; ++x) {
            rays.push_back(camera_ray(view.camera, view.size, vec2(x, y) + 0.5f));
            Hits hits;
            hits.instance.fill(-1);
            const std::span one{&rays.back(), 1};
            if (snapshot.occluders && !snapshot.occluders->empty()) snapshot.occluders->closest(one, 0, hits);
            rays.back().t_max = hits.instance[0] >= 0 ? hits.t[0] : far;
        }
    return rays;
}

inline std::vector<Scatter> scattered(const ScatterFunction& scatter, const std::vector<Ray>& rays, size_t batch = 16) {
    std::vector<Scatter> results(rays.size());
    const std::vector<uint32_t> ids(16, 7);
    for (size_t first = 0; first < rays.size(); first += batch) {
        const size_t count = std::min(batch, rays.size() - first);
        scatter({std::span(rays).subspan(first, count), std::span(ids).first(count), {}, {}},
                std::span(results).subspan(first, count));
    }
    return results;
}

inline ScatterFunction froxels(const View& view, const Snapshot& snapshot, const Settings& settings,
                               History* history = nullptr) {
    return find_mode("froxel").prepare(view, snapshot, settings, history);
}

inline double mean_radiance(const std::vector<Scatter>& results) {
    double sum = 0;
    for (const Scatter& result : results) sum += result.radiance.x;
    return sum / static_cast<double>(results.size());
}

// Root of the mean squared difference, over the mean of `truth`.
inline double relative_rmse(const std::vector<Scatter>& results, const std::vector<Scatter>& truth) {
    double squares = 0;
    for (size_t i = 0; i < results.size(); ++i) {
        const double difference = results[i].radiance.x - truth[i].radiance.x;
        squares += difference * difference;
    }
    return std::sqrt(squares / static_cast<double>(results.size())) / mean_radiance(truth);
}
}
