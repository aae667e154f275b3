#include "support/run_mode.h"

#include "scene/camera.h"
#include "scene/light.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"

namespace tyndall::test {
namespace {
std::vector<Scatter> taken(const ScatterFunction& scatter, const std::vector<Ray>& rays, size_t packet, size_t parts,
                           std::vector<vec3>* of_parts) {
    std::vector<Scatter> results(rays.size());
    const std::vector<uint32_t> ids(packet, 7);
    if (of_parts) of_parts->assign(rays.size() * parts, vec3(0));
    for (size_t first = 0; first < rays.size(); first += packet) {
        const size_t count = std::min(packet, rays.size() - first);
        RayBatch batch{.rays = std::span(rays).subspan(first, count), .ids = std::span(ids).first(count)};
        if (of_parts) batch.parts = std::span(*of_parts).subspan(first * parts, count * parts);
        scatter(batch, std::span(results).subspan(first, count));
    }
    return results;
}
}

View view_of(vec3 eye, vec3 target, ivec2 size, float vertical_fov) {
    View view;
    view.camera = look_at(eye, target, {0, 1, 0}, vertical_fov);
    view.size = size;
    return view;
}

std::vector<Ray> pixel_rays(const View& view, const Snapshot& snapshot, float far) {
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

double mean_of(const std::vector<Scatter>& results) {
    double sum = 0;
    for (const Scatter& result : results) sum += luminance(result.radiance);
    return sum / static_cast<double>(results.size());
}

double rms_difference(const std::vector<Scatter>& a, const std::vector<Scatter>& b) {
    double sum = 0;
    for (size_t i = 0; i < a.size(); ++i) sum += std::pow(luminance(a[i].radiance - b[i].radiance), 2);
    return std::sqrt(sum / static_cast<double>(a.size()));
}

double relative_rmse(const std::vector<Scatter>& results, const std::vector<Scatter>& truth) {
    return rms_difference(results, truth) / mean_of(truth);
}

std::vector<Scatter> scattered(const ScatterFunction& scatter, const std::vector<Ray>& rays, size_t packet) {
    return taken(scatter, rays, packet, 0, nullptr);
}

std::vector<Scatter> run_mode(std::string_view mode, const View& view, const Snapshot& snapshot,
                              const Settings& settings, const std::vector<Ray>& rays, std::vector<vec3>* of_parts) {
    const ScatterFunction scatter = find_mode(mode).prepare(view, snapshot, settings, nullptr);
    return taken(scatter, rays, 16, part_count(snapshot.lights.size()), of_parts);
}

std::vector<Scatter> marched(const Snapshot& snapshot, const Settings& settings, const std::vector<Ray>& rays) {
    return run_mode("march", View{}, snapshot, settings, rays);
}

Scatter marched(const Snapshot& snapshot, const Settings& settings, const Ray& ray) {
    return marched(snapshot, settings, std::vector{ray})[0];
}

Settings exact_settings() { return settings_for(Quality::reference); }

Settings sampled_settings() {
    Settings settings = exact_settings();
    settings.march.visibility = Visibility::rays;
    settings.march.step_depth = 0.02f, settings.march.step_voxels = 0.5f, settings.march.step_share = 1.0f / 512;
    settings.march.near_light = 0.1f;
    return settings;
}

Settings sliced_settings() {
    Settings settings = sampled_settings();
    settings.march.visibility = Visibility::intervals;
    return settings;
}
}
