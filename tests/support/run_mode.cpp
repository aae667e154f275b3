#include "support/run_mode.h"

#include "scene/light.h"
#include "trace/snapshot.h"

namespace tyndall::test {
namespace {
std::vector<Scatter> taken(const ScatterFunction& scatter, const std::vector<Ray>& rays, size_t packet, size_t lights,
                           std::vector<vec3>* per_light) {
    std::vector<Scatter> results(rays.size());
    const std::vector<uint32_t> ids(packet, 7);
    if (per_light) per_light->assign(rays.size() * lights, vec3(0));
    for (size_t first = 0; first < rays.size(); first += packet) {
        const size_t count = std::min(packet, rays.size() - first);
        RayBatch batch{std::span(rays).subspan(first, count), std::span(ids).first(count), {}, {}};
        if (per_light) batch.per_light = std::span(*per_light).subspan(first * lights, count * lights);
        scatter(batch, std::span(results).subspan(first, count));
    }
    return results;
}
}

std::vector<Scatter> scattered(const ScatterFunction& scatter, const std::vector<Ray>& rays, size_t packet) {
    return taken(scatter, rays, packet, 0, nullptr);
}

std::vector<Scatter> run_mode(std::string_view mode, const View& view, const Snapshot& snapshot,
                              const Settings& settings, const std::vector<Ray>& rays, std::vector<vec3>* per_light) {
    const ScatterFunction scatter = find_mode(mode).prepare(view, snapshot, settings, nullptr);
    return taken(scatter, rays, 16, snapshot.lights.size(), per_light);
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
