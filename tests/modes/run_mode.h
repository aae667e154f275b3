// Any mode on a list of rays, in packets of sixteen.
#pragma once
#include "tiny_scenes.h"

namespace tyndall::test {
inline std::vector<Scatter> run_mode(const char* mode, const View& view, const Snapshot& snapshot,
                                     const Settings& settings, const std::vector<Ray>& rays,
                                     std::vector<vec3>* per_light = nullptr) {
    const ScatterFunction scatter = find_mode(mode).prepare(view, snapshot, settings, nullptr);
    std::vector<Scatter> results(rays.size());
    const std::vector<uint32_t> ids(16, 7);
    const size_t lights = snapshot.lights.size();
    if (per_light) per_light->assign(rays.size() * lights, vec3(0));
    for (size_t first = 0; first < rays.size(); first += 16) {
        const size_t count = std::min<size_t>(16, rays.size() - first);
        RayBatch batch{std::span(rays).subspan(first, count), std::span(ids).first(count), {}, {}};
        if (per_light) batch.per_light = std::span(*per_light).subspan(first * lights, count * lights);
        scatter(batch, std::span(results).subspan(first, count));
    }
    return results;
}
}
