#include "modes/ambient_limitations.h"

#include "base/random.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/rays/fog_reach.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tyndall {
namespace {
constexpr uint32_t points = 32, directions = 16; // directions of a point: one packet of rays

// The phase function of the medium that scatters most at a point.
const Phase& main_phase(const Snapshot& snapshot, vec3 point) {
    const auto scattering = [&](const Medium& medium) {
        return density_at(medium, point) * gray_extinction(medium.optics) * max_component(medium.optics.albedo);
    };
    return std::ranges::max_element(snapshot.media, {}, scattering)->optics.phase;
}

// Where the fog of a camera ray is seen: a point drawn in proportion to its light under even illumination, and the
// opacity of the whole ray.
struct SeenFog {
    vec3 point, direction;
    double opacity;
};

std::optional<SeenFog> seen_fog(const Snapshot& snapshot, Ray ray, float random) {
    ray.t_max = std::min(ray.t_max, fog_reach(snapshot.media, ray));
    if (snapshot.occluders) {
        Hits hits;
        snapshot.occluders->closest({&ray, 1}, 0, hits);
        ray.t_max = std::min(ray.t_max, hits.t[0]);
    }
    const auto depth_to = [&](float t) { return optical_depth(snapshot.media, {ray.origin, ray.direction, t}); };
    const double opacity = -std::expm1(-depth_to(ray.t_max));
    if (!(opacity > 0)) return std::nullopt;
    const double depth = -std::log1p(-opacity * double{random});
    float low = 0, high = ray.t_max;
    for (int i = 0; i < 12; ++i) {
        const float middle = 0.5f * (low + high);
        (depth_to(middle) < depth ? low : high) = middle;
    }
    return SeenFog{ray.origin + 0.5f * (low + high) * ray.direction, ray.direction, opacity};
}

// Fraction of the ambient light scattered at a point that gets there.
double openness(const Snapshot& snapshot, const SeenFog& seen, uint32_t seed) {
    const Phase& phase = main_phase(snapshot, seen.point);
    double sum = 0;
    Occluders::ShadowRays rays;
    alignas(64) float passes[16];
    std::fill_n(passes, 16, 1.0f);
    for (uint32_t i = 0; i < directions; ++i) {
        const Sample2 u = sample2(i, seed);
        rays.set(i, {seen.point, sample_phase(phase, seen.direction, {u.x, u.y}), infinity});
    }
    if (snapshot.occluders) snapshot.occluders->transmission(rays, passes);
    for (uint32_t i = 0; i < directions; ++i)
        if (passes[i] > 0)
            sum +=
                double{passes[i]} *
                std::exp(-optical_depth(snapshot.media, {seen.point, {rays.dx[i], rays.dy[i], rays.dz[i]}, infinity}));
    return sum / directions;
}
}

double blocked_ambient(const View& view, const Snapshot& snapshot) {
    double open = 0, all = 0;
    for (uint32_t i = 0; i < points; ++i) {
        const Sample2 u = sample2(i, 1);
        const Ray ray = camera_ray(view.camera, view.size, vec2(u.x, u.y) * vec2(view.size));
        const auto seen = seen_fog(snapshot, ray, random_unit(i, 0, 0, 2));
        if (!seen) continue;
        open += seen->opacity * openness(snapshot, *seen, hash(3u, i)), all += seen->opacity;
    }
    return all > 0 ? 1 - open / all : 0;
}

void add_unshadowed_ambient(const View& view, const Snapshot& snapshot, Limitations& limitations) {
    if (!(max_component(snapshot.ambient) > 0)) return;
    limitations.push_back(
        {Severity::info, &limitation::unshadowed_ambient, Subject::scene, "", {100 * blocked_ambient(view, snapshot)}});
}
}
