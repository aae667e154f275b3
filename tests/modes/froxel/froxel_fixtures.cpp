#include "modes/froxel/froxel_fixtures.h"

#include "scene/camera.h"
#include "trace/occlusion/occluders.h"
#include "trace/view.h"

namespace tyndall::test {
Stage half_shadowed_fog() {
    return stage_of({even_medium(0.3f, {vec3(-3, 0, -3), vec3(3, 3, 3)})}, {sun_light({0.3f, -1, 0.1f}, 2)},
                    {quad({-50, 4, -50}, {50.2f, 0, 0}, {0, 0, 100})});
}

View view_of(vec3 position, vec3 target, ivec2 size) {
    View view;
    view.camera = look_at(position, target, {0, 1, 0}, 0.8f);
    view.size = size;
    return view;
}

std::vector<Ray> picture_rays(const View& view, const Snapshot& snapshot, float far) {
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

ScatterFunction froxels(const View& view, const Snapshot& snapshot, const Settings& settings, History* history) {
    return find_mode("froxel").prepare(view, snapshot, settings, history);
}

double mean_radiance(const std::vector<Scatter>& results) {
    double sum = 0;
    for (const Scatter& result : results) sum += result.radiance.x;
    return sum / static_cast<double>(results.size());
}

double relative_rmse(const std::vector<Scatter>& results, const std::vector<Scatter>& truth) {
    double squares = 0;
    for (size_t i = 0; i < results.size(); ++i) {
        const double difference = results[i].radiance.x - truth[i].radiance.x;
        squares += difference * difference;
    }
    return std::sqrt(squares / static_cast<double>(results.size())) / mean_radiance(truth);
}
}
