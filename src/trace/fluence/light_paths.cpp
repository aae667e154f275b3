#include "trace/fluence/light_paths.h"

#include "scene/light.h"
#include "trace/fluence/light_emission.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"
#include "trace/surface.h"
#include "volume/medium.h"
#include "volume/tracking.h"

#include <algorithm>

namespace tyndall {
namespace {
constexpr int certain_orders = 4;    // scattering events before Russian roulette may end a path
constexpr int max_segments = 65536;  // per path, passed BLEND surfaces included; Russian roulette ends it sooner
constexpr size_t paths_at_once = 16; // one packet of the ray tracer

bool is_endless(const Medium& medium) { return !is_finite(medium.world_bounds.size()); }

// A path, at its current vertex.
struct LightPath {
    Ray ray;
    vec3 light{0}; // power at the light, over the path's probability
    vec3 throughput{1};
    int square = 0, order = 0, segments = 0;
    size_t stratum = 0;
    float recorded = 0; // Σ power · length of the recorded segments
    bool alive = false;
    RandomStream random;

    vec2 pair() {
        const float x = random.next();
        return {x, random.next()};
    }
};

// What all paths share.
struct LightTracing {
    const Snapshot& snapshot;
    const RayStrata& strata;
    const LightPathRules& rules;
    std::span<const LightSquare> squares;
    bool endless; // whether any medium is unbounded
    LightPathResult& result;
};

// Starts path `index` of `total`.
LightPath start(const LightTracing& tracing, int64_t index, int64_t total) {
    LightPath path;
    path.random = {hash(tracing.rules.seed, static_cast<uint32_t>(index), static_cast<uint32_t>(index >> 32))};
    const std::vector<double>& sums = tracing.strata.cumulative;
    const double wanted = (static_cast<double>(index) + path.random.next()) / static_cast<double>(total);
    const auto found = std::ranges::upper_bound(sums, wanted * sums.back());
    path.stratum = std::min<size_t>(static_cast<size_t>(found - sums.begin()), sums.size() - 1);
    const double probability = sums[path.stratum] - (path.stratum > 0 ? sums[path.stratum - 1] : 0.0);
    if (!(probability > 0)) return path;

    const int side = tracing.strata.side, count = side * side, stratum = static_cast<int>(path.stratum) % count;
    path.square = static_cast<int>(path.stratum) / count;
    const LightSquare& square = tracing.squares[static_cast<size_t>(path.square)];
    const vec2 in_square = (vec2(stratum % side, stratum / side) + path.pair()) / static_cast<float>(side);
    path.ray = square.ray(in_square, path.pair());
    const Interval<float> inside = clip(tracing.rules.reach, path.ray.origin, path.ray.direction, {0, infinity});
    if (inside.empty()) return path;
    vec3 left = square.share(path.ray);
    path.ray.origin = path.ray.at(inside.low);
    if (tracing.endless && is_distant(*square.light))
        left *= static_cast<float>(
            std::exp(-optical_depth(tracing.snapshot.media, {path.ray.origin, -path.ray.direction, infinity})));
    path.light = square.power * (left / static_cast<float>(probability * count * static_cast<double>(total)));
    path.alive = max_component(path.light) > 0;
    return path;
}

// Records the part of a segment inside rules.recorded, unless its light comes straight from the source.
void record(const LightTracing& tracing, LightPath& path, float length) {
    if (path.order == 0 || path.order >= tracing.rules.orders) return;
    const Interval<float> inside = clip(tracing.rules.recorded, path.ray.origin, path.ray.direction, {0, length});
    if (inside.empty()) return;
    const vec3 light = path.light * path.throughput;
    tracing.result.segments.push_back({path.ray.at(inside.low), path.ray.direction, inside.length(), light});
    path.recorded += luminance(light) * inside.length();
}

// Attenuation by the light's range, for light straight from it.
float range_attenuation(const LightTracing& tracing, const LightPath& path, vec3 point) {
    const Light& light = *tracing.squares[static_cast<size_t>(path.square)].light;
    return is_distant(light) ? 1 : range_window(glm::length(point - light.position), light.range);
}

// Continues the path with a new ray and a factor on its throughput, unless Russian roulette ends it.
void continue_path(const LightTracing& tracing, LightPath& path, Ray ray, vec3 share) {
    path.throughput *= share, path.ray = ray;
    ++path.order;
    const float left = max_component(path.throughput);
    path.alive = path.order < tracing.rules.orders && left > 0;
    if (!path.alive || path.order < certain_orders || left >= 1) return;
    path.alive = path.random.next() < left;
    path.throughput /= left;
}

void scatter(const LightTracing& tracing, LightPath& path, const Optics& optics, float distance) {
    const vec3 point = path.ray.at(distance);
    const Light& light = *tracing.squares[static_cast<size_t>(path.square)].light;
    vec3 share = albedo_at(optics, point);
    if (path.order == 0) share *= light.volume_scale * range_attenuation(tracing, path, point);
    tracing.result.first_scatterings += path.order == 0;
    (path.order == 0 ? tracing.result.scattered_once : tracing.result.scattered_more) +=
        luminance(path.light * path.throughput * share);
    continue_path(tracing, path, {point, sample_phase(optics.phase, path.ray.direction, path.pair())}, share);
}

// Lambertian reflection, or passage. Light from a source that the surface does not shadow is both transmitted and
// reflected, each in half of the paths; light that is not linked to the surface is not reflected.
void hit_surface(const LightTracing& tracing, LightPath& path, const SurfacePoint& surface, float distance) {
    const Light& light = *tracing.squares[static_cast<size_t>(path.square)].light;
    const bool lit = path.order > 0 || is_lit(light, tracing.snapshot, surface.instance);
    const bool through = path.order == 0 && !shadows_light(light, tracing.snapshot, surface.instance);
    const float reflecting = !through ? surface.alpha : lit ? 0.5f : 0.0f;
    if (path.random.next() >= reflecting) {
        if (through && lit) path.throughput *= 2.0f;
        const vec3 point = path.ray.at(distance);
        path.ray.origin = point + path.ray.direction * surface_skip(point, distance);
        return;
    }
    if (!lit) return void(path.alive = false);
    const float facing = std::abs(glm::dot(surface.face_normal, path.ray.direction));
    const float shaded = std::max(0.0f, -glm::dot(surface.normal, path.ray.direction));
    vec3 share = facing > 0 ? surface.base_color * (shaded / facing) : vec3(0);
    if (through) share *= 2 * surface.alpha;
    if (path.order == 0) share *= light.surface_scale * range_attenuation(tracing, path, surface.position);
    const vec3 origin = surface.position + surface.face_normal * shadow_offset(surface.position);
    continue_path(tracing, path, {origin, cosine_direction(surface.face_normal, path.pair())}, share);
}

// One segment of a path, up to a collision or the surface at distance `surface_distance`.
void trace_segment(const LightTracing& tracing, LightPath& path, float surface_distance, const auto& surface_at) {
    float nearest = std::min(surface_distance, path.ray.t_max);
    const Medium* hit = nullptr;
    int lookups = 0;
    for (const Medium& medium : tracing.snapshot.media) {
        if (only_emits(medium.optics)) continue;
        const float t = collision_distance(medium, path.ray, {0, nearest}, path.random.next(), path.random, lookups);
        if (t < nearest) nearest = t, hit = &medium;
    }
    record(tracing, path, nearest);
    if (hit) return scatter(tracing, path, hit->optics, nearest);
    if (!(surface_distance < path.ray.t_max)) return void(path.alive = false);
    hit_surface(tracing, path, surface_at(), nearest);
}

// Traces one segment for each of up to sixteen paths.
void trace_segments(const LightTracing& tracing, std::span<LightPath*> paths) {
    const Occluders* occluders = tracing.snapshot.occluders.get();
    Ray rays[paths_at_once];
    Hits hits;
    for (size_t i = 0; i < paths.size(); ++i) {
        Ray& ray = paths[i]->ray;
        ray.t_max = clip(tracing.rules.reach, ray.origin, ray.direction, {0, infinity}).high;
        rays[i] = ray;
    }
    hits.instance.fill(-1), hits.t.fill(infinity);
    if (occluders && !occluders->empty()) occluders->closest({rays, paths.size()}, 0, hits, false);
    for (size_t i = 0; i < paths.size(); ++i) {
        const float surface_distance = hits.instance[i] >= 0 ? hits.t[i] : infinity;
        trace_segment(tracing, *paths[i], surface_distance,
                      [&] { return occluders->surface(rays[i], hits, static_cast<int>(i)); });
        if (++paths[i]->segments == max_segments) paths[i]->alive = false;
    }
}
}

Box light_reach(const Snapshot& snapshot) {
    Box reach;
    float thickest = 0; // largest extinction of unbounded fog, 1/m
    for (const Medium& medium : snapshot.media) {
        if (is_endless(medium))
            thickest = std::max(thickest, medium.majorant());
        else
            reach.grow(medium.world_bounds);
    }
    if (snapshot.occluders && !snapshot.occluders->empty()) reach.grow(snapshot.occluders->bounds());
    if (!reach.empty()) { // keeps surfaces at the scene's border inside
        const float margin = 1e-3f * max_component(reach.size()) + shadow_offset(glm::max(-reach.low, reach.high));
        reach.low -= margin, reach.high += margin;
    }
    if (thickest == 0) return reach;
    for (const Light& light : snapshot.lights) reach.grow(light_bounds(light));
    if (reach.empty()) reach = snapshot.bounds;
    if (reach.empty()) reach.grow(vec3(0));
    const float size = glm::length(reach.size());
    const float further = std::min(2 / thickest, size > 0 ? size : snapshot.extent);
    reach.low -= further, reach.high += further;
    return reach;
}

Box fog_bounds(const Snapshot& snapshot, const Box& reach) {
    Box fog;
    for (const Medium& medium : snapshot.media) {
        if (only_emits(medium.optics)) continue;
        const Box& box = medium.world_bounds;
        const Box inside{glm::max(box.low, reach.low), glm::min(box.high, reach.high)};
        if (!inside.empty()) fog.grow(inside);
    }
    return fog;
}

bool has_lights(const Snapshot& snapshot) { return !snapshot.lights.empty() || snapshot.environment; }

RayStrata even_strata(const Snapshot& snapshot, const Box& reach, int side) {
    RayStrata strata{side, {}};
    double sum = 0;
    for (const LightSquare& square : squares_of(snapshot, reach))
        for (int i = 0; i < side * side; ++i) strata.cumulative.push_back(sum += square.weight / (side * side));
    for (double& each : strata.cumulative) each /= sum;
    return strata;
}

void trace_light_paths(const Snapshot& snapshot, const RayStrata& strata, const LightPathRules& rules, int64_t first,
                       int64_t count, int64_t total, LightPathResult& result, int64_t step) {
    const std::vector<LightSquare> squares = squares_of(snapshot, rules.reach);
    const LightTracing tracing{snapshot, strata, rules, squares, std::ranges::any_of(snapshot.media, is_endless),
                               result};
    LightPath paths[paths_at_once];
    for (int64_t done = 0; done < count; done += paths_at_once) {
        const size_t some = static_cast<size_t>(std::min<int64_t>(paths_at_once, count - done));
        for (size_t i = 0; i < some; ++i)
            paths[i] = start(tracing, first + step * (done + static_cast<int64_t>(i)), total);
        for (;;) {
            LightPath* alive[paths_at_once];
            size_t left = 0;
            for (size_t i = 0; i < some; ++i)
                if (paths[i].alive) alive[left++] = &paths[i];
            if (left == 0) break;
            trace_segments(tracing, {alive, left});
        }
        for (size_t i = 0; i < some; ++i) {
            result.hits += paths[i].recorded > 0;
            if (!result.of_stratum.empty())
                result.of_stratum[paths[i].stratum] += paths[i].recorded * paths[i].recorded;
        }
    }
}
}
