#include "modes/ambient_limitations.h"

#include "base/random.h"
#include "integrate/lights/fog_points.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/rays/fog_reach.h"

#include <algorithm>
#include <cmath>

namespace tyndall {
namespace {
constexpr uint32_t points = 32, directions = 16; // directions of a point: one packet of rays

// Fraction of the ambient light that reaches a point of the fog, weighted by the phase functions.
double openness(const Snapshot& snapshot, const FogSample& fog, uint32_t seed) {
    Occluders::ShadowRays rays;
    alignas(64) float passes[16];
    std::fill_n(passes, 16, 1.0f);
    for (uint32_t i = 0; i < directions; ++i) {
        const Sample2 u = sample2(i, seed);
        const float which = random_unit(i, 0, 0, seed);
        rays.set(i, {fog.point, direction_by_phase(snapshot.media, fog, which, {u.x, u.y}), infinity});
    }
    if (snapshot.occluders) snapshot.occluders->transmission(rays, passes);
    double sum = 0;
    for (uint32_t i = 0; i < directions; ++i) {
        const Ray ray{fog.point, {rays.dx[i], rays.dy[i], rays.dz[i]}, infinity};
        if (passes[i] > 0) sum += double{passes[i]} * std::exp(-optical_depth(snapshot.media, ray));
    }
    return sum / directions;
}

// The ray through a point of the image, up to the first surface or the end of the fog.
Ray visible_ray(const View& view, const Snapshot& snapshot, Sample2 at) {
    Ray ray = camera_ray(view.camera, view.size, vec2(at.x, at.y) * vec2(view.size));
    ray.t_max = std::min(ray.t_max, fog_reach(snapshot.media, ray));
    if (!snapshot.occluders) return ray;
    Hits hits;
    snapshot.occluders->closest({&ray, 1}, 0, hits);
    ray.t_max = std::min(ray.t_max, hits.t[0]);
    return ray;
}
}

double blocked_ambient(const View& view, const Snapshot& snapshot) {
    double open = 0, all = 0;
    FogPieces fog;
    for (uint32_t i = 0; i < points; ++i) {
        const Ray ray = visible_ray(view, snapshot, sample2(i, 1));
        find_fog(ray, snapshot.media, 0, fog);
        if (!(fog.depth > 0)) continue;
        const FogSampler sampler = fog_sampler(fog, 1);
        size_t piece = 0;
        const double t = sampler.distance(random_unit(i, 0, 0, 2), piece);
        FogSample seen;
        if (!(evaluate_fog(fog, piece, ray, t, seen) > 0)) continue;
        open += sampler.whole * openness(snapshot, seen, hash(3u, i)), all += sampler.whole;
    }
    return all > 0 ? 1 - open / all : 0;
}

void add_unshadowed_ambient(const View& view, const Snapshot& snapshot, Limitations& limitations) {
    if (!(max_component(snapshot.ambient) > 0)) return;
    limitations.push_back(
        {Severity::info, &limitation::unshadowed_ambient, Subject::scene, "", {100 * blocked_ambient(view, snapshot)}});
}
}
