#include "modes/path/path_rays.h"

#include "base/random.h"
#include "modes/mode.h"
#include "modes/settings.h"
#include "scene/light.h"
#include "support/random_points.h"
#include "trace/snapshot.h"
#include "trace/view.h"

namespace tyndall::test {
std::vector<Ray> lines_through(vec3 center, float radius, int count) {
    std::vector<Ray> rays;
    for (uint32_t i = 0; i < static_cast<uint32_t>(count); ++i) {
        const vec3 direction = random_direction(i, 5);
        vec3 x, y;
        make_frame(direction, x, y);
        const Sample2 u = sample2(i, 6);
        const float away = radius * std::sqrt(u.x), turned = 2 * pi * u.y;
        const vec3 from = away * (std::cos(turned) * x + std::sin(turned) * y);
        rays.push_back({center - 2 * radius * direction + from, direction, 4 * radius});
    }
    return rays;
}

std::vector<Scatter> path_light(const Snapshot& snapshot, const std::vector<Ray>& rays, int orders) {
    Settings settings;
    settings.path.orders = orders;
    const ScatterFunction scatter = find_mode("path").prepare(View{}, snapshot, settings, nullptr);
    std::vector<Scatter> results(rays.size());
    for (size_t first = 0; first < rays.size(); first += 16) {
        const size_t count = std::min<size_t>(16, rays.size() - first);
        uint32_t ids[16];
        for (size_t i = 0; i < count; ++i) ids[i] = hash(static_cast<uint32_t>(first + i), 31u);
        scatter({.rays = std::span(rays).subspan(first, count), .ids = {ids, count}},
                std::span(results).subspan(first, count));
    }
    return results;
}

Mean mean_of(const std::vector<double>& values) {
    const double count = static_cast<double>(values.size());
    Mean mean;
    for (const double value : values) mean.value += value / count;
    for (const double value : values) mean.error += (value - mean.value) * (value - mean.value);
    mean.error = std::sqrt(mean.error) / count;
    return mean;
}

std::vector<double> difference(const std::vector<Scatter>& a, const std::vector<Scatter>& b, double factor) {
    std::vector<double> result;
    for (size_t i = 0; i < a.size(); ++i)
        result.push_back(luminance(a[i].radiance) - factor * luminance(b[i].radiance));
    return result;
}

vec3 all_light(const Scatter& s) { return s.whole(); }

vec3 fog_light(const Scatter& s) { return s.radiance; }

vec3 surface_light(const Scatter& s) { return s.surface + s.background; }

ScatterFunction path_mode(const Snapshot& snapshot, int orders) {
    Settings settings;
    settings.path.orders = orders;
    return find_mode("path").prepare(View{}, snapshot, settings, nullptr);
}

RayEstimate traced(const Snapshot& snapshot, const Ray& ray, int samples, int orders) {
    return estimate_ray(path_mode(snapshot, orders), ray, samples, all_light);
}
}
