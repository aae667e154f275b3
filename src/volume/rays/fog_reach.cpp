// Finds the effective end of unbounded fog by doubling, using its analytic optical depth.
#include "volume/rays/fog_reach.h"

namespace tyndall {
namespace {
constexpr float horizon = 1e12f;    // meters; no ray goes farther
constexpr double opaque_depth = 20; // e^-20 = 2e-9
constexpr double negligible_depth = 1e-6;

double depth_to(const Medium& medium, Ray ray, float distance) {
    ray.t_max = distance;
    return optical_depth(medium, ray);
}

float reach_of_unbounded(const Medium& medium, const Ray& ray) {
    const double total = depth_to(medium, ray, horizon);
    if (!(total > negligible_depth)) return 0;
    const double enough = std::min(opaque_depth, total - negligible_depth);

    float low = 0, high = std::min(1 / medium.majorant(), horizon);
    while (high < horizon && depth_to(medium, ray, high) < enough) low = high, high *= 2;
    for (int i = 0; i < 4; ++i) {
        const float middle = 0.5f * (low + high);
        (depth_to(medium, ray, middle) < enough ? low : high) = middle;
    }
    return std::min(high, horizon);
}
}

float fog_reach(std::span<const Medium> media, const Ray& ray) {
    float reach = 0;
    for (const Medium& medium : media) {
        const Interval<float> inside = clip(medium.world_bounds, ray.origin, ray.direction, {0, ray.t_max});
        if (inside.empty() || inside.high <= reach) continue;
        const float end = std::isinf(inside.high) ? reach_of_unbounded(medium, ray) : inside.high;
        reach = std::max(reach, std::min(end, horizon));
    }
    return std::min(reach, ray.t_max);
}

Interval<float> fog_interval(std::span<const Medium> media, const Ray& ray) {
    return fog_interval(media, ray, [](const Medium&, const Interval<float>&) { return infinity; });
}
}
