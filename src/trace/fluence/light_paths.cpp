#include "trace/fluence/light_paths.h"

#include "scene/light.h"
#include "trace/fluence/light_emission.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"
#include "volume/medium.h"
#include "volume/tracking.h"

#include <algorithm>

namespace tyndall {
namespace {
constexpr int certain_orders = 4;      // scattering events before Russian roulette may end a path
constexpr int max_flights = 65536;     // per path, passed BLEND surfaces included; Russian roulette ends it sooner
constexpr size_t walkers_at_once = 16; // one packet of the ray tracer

bool is_endless(const Medium& medium) { return !is_finite(medium.world_bounds.size()); }

// The current vertex of a path.
struct PathVertex {
    Ray ray;
    vec3 light{0}; // power at the light, over the path's probability
    vec3 share{1}; // throughput
    int light_index = 0, order = 0, flights = 0;
    size_t stratum = 0;
    float flown = 0; // Σ power · length of the recorded flights
    bool walking = false;
    RandomStream random;

    vec2 pair() {
        const float x = random.next();
        return {x, random.next()};
    }
};

struct Walk {
    const Snapshot& snapshot;
    const RayStrata& strata;
    const LightPathRules& rules;
    std::span<const LightSquare> squares;
    bool endless; // whether any medium is unbounded
    LightPathResult& result;
};

// Starts path `index` of `total`.
PathVertex start(const Walk& walk, int64_t index, int64_t total) {
    PathVertex walker;
    walker.random = {hash(walk.rules.seed, static_cast<uint32_t>(index), static_cast<uint32_t>(index >> 32))};
    const std::vector<double>& sums = walk.strata.cumulative;
    const double wanted = (static_cast<double>(index) + walker.random.next()) / static_cast<double>(total);
    const auto found = std::ranges::upper_bound(sums, wanted * sums.back());
    walker.stratum = std::min<size_t>(static_cast<size_t>(found - sums.begin()), sums.size() - 1);
    const double chance = sums[walker.stratum] - (walker.stratum > 0 ? sums[walker.stratum - 1] : 0.0);
    if (!(chance > 0)) return walker;

    const int side = walk.strata.side, count = side * side, stratum = static_cast<int>(walker.stratum) % count;
    walker.light_index = static_cast<int>(walker.stratum) / count;
    const LightSquare& square = walk.squares[static_cast<size_t>(walker.light_index)];
    const vec2 place = (vec2(stratum % side, stratum / side) + walker.pair()) / static_cast<float>(side);
    walker.ray = square.ray(place, walker.pair());
    const Interval<float> inside = clip(walk.rules.reach, walker.ray.origin, walker.ray.direction, {0, infinity});
    if (inside.empty()) return walker;
    vec3 left = square.share(walker.ray);
    walker.ray.origin = walker.ray.at(inside.low);
    if (walk.endless && is_distant(*square.light))
        left *= static_cast<float>(
            std::exp(-optical_depth(walk.snapshot.media, {walker.ray.origin, -walker.ray.direction, infinity})));
    walker.light = square.power * (left / static_cast<float>(chance * count * static_cast<double>(total)));
    walker.walking = max_component(walker.light) > 0;
    return walker;
}

// Records the part of a flight inside rules.noted, unless its light comes straight from the source.
void note(const Walk& walk, PathVertex& walker, float length) {
    if (walker.order == 0 || walker.order >= walk.rules.orders) return;
    const Interval<float> inside = clip(walk.rules.noted, walker.ray.origin, walker.ray.direction, {0, length});
    if (inside.empty()) return;
    const vec3 light = walker.light * walker.share;
    walk.result.flights.push_back({walker.ray.at(inside.low), walker.ray.direction, inside.length(), light});
    walker.flown += luminance(light) * inside.length();
}

// Attenuation by the light's range, for light straight from it.
float ranged(const Walk& walk, const PathVertex& walker, vec3 point) {
    const Light& light = *walk.squares[static_cast<size_t>(walker.light_index)].light;
    return is_distant(light) ? 1 : range_window(glm::length(point - light.position), light.range);
}

// Continues the path with a new ray and a factor on its throughput, unless Russian roulette ends it.
void turn(const Walk& walk, PathVertex& walker, Ray ray, vec3 share) {
    walker.share *= share, walker.ray = ray;
    ++walker.order;
    const float left = max_component(walker.share);
    walker.walking = walker.order < walk.rules.orders && left > 0;
    if (!walker.walking || walker.order < certain_orders || left >= 1) return;
    walker.walking = walker.random.next() < left;
    walker.share /= left;
}

void scatter(const Walk& walk, PathVertex& walker, const Optics& optics, float distance) {
    const vec3 point = walker.ray.at(distance);
    const Light& light = *walk.squares[static_cast<size_t>(walker.light_index)].light;
    vec3 share = albedo_at(optics, point);
    if (walker.order == 0) share *= light.volume_scale * ranged(walk, walker, point);
    walk.result.first_scatterings += walker.order == 0;
    (walker.order == 0 ? walk.result.scattered_once : walk.result.scattered_more) +=
        luminance(walker.light * walker.share * share);
    turn(walk, walker, {point, sample_phase(optics.phase, walker.ray.direction, walker.pair())}, share);
}

// Lambertian reflection, or passage. Light from a source that the surface does not shadow is both transmitted and
// reflected, each in half of the paths; light that is not linked to the surface is not reflected.
void meet(const Walk& walk, PathVertex& walker, const SurfacePoint& surface, float distance) {
    const Light& light = *walk.squares[static_cast<size_t>(walker.light_index)].light;
    const bool lit = walker.order > 0 || is_lit(light, walk.snapshot, surface.instance);
    const bool through = walker.order == 0 && !shadows_light(light, walk.snapshot, surface.instance);
    const float reflecting = !through ? surface.alpha : lit ? 0.5f : 0.0f;
    if (walker.random.next() >= reflecting) {
        if (through && lit) walker.share *= 2.0f;
        const vec3 point = walker.ray.at(distance);
        walker.ray.origin = point + walker.ray.direction * std::max(shadow_offset(point), 4e-6f * distance);
        return;
    }
    if (!lit) return void(walker.walking = false);
    const float facing = std::abs(glm::dot(surface.face_normal, walker.ray.direction));
    const float shaded = std::max(0.0f, -glm::dot(surface.normal, walker.ray.direction));
    vec3 share = facing > 0 ? surface.base_color * (shaded / facing) : vec3(0);
    if (through) share *= 2 * surface.alpha;
    if (walker.order == 0) share *= light.surface_scale * ranged(walk, walker, surface.position);
    vec3 x, y;
    make_frame(surface.face_normal, x, y);
    const vec2 u = walker.pair();
    const float across = std::sqrt(u.x), angle = 2 * pi * u.y;
    const vec3 direction = glm::normalize(across * std::cos(angle) * x + across * std::sin(angle) * y +
                                          std::sqrt(std::max(0.0f, 1 - u.x)) * surface.face_normal);
    turn(walk, walker, {surface.position + surface.face_normal * shadow_offset(surface.position), direction}, share);
}

// One flight of a path, up to a collision or the surface at distance `wall`.
void fly(const Walk& walk, PathVertex& walker, float wall, const auto& surface_at) {
    float nearest = std::min(wall, walker.ray.t_max);
    const Medium* hit = nullptr;
    int lookups = 0;
    for (const Medium& medium : walk.snapshot.media) {
        if (only_emits(medium.optics)) continue;
        const float t =
            collision_distance(medium, walker.ray, {0, nearest}, walker.random.next(), walker.random, lookups);
        if (t < nearest) nearest = t, hit = &medium;
    }
    note(walk, walker, nearest);
    if (hit) return scatter(walk, walker, hit->optics, nearest);
    if (!(wall < walker.ray.t_max)) return void(walker.walking = false);
    meet(walk, walker, surface_at(), nearest);
}

// Traces one flight for each of up to sixteen paths.
void fly_all(const Walk& walk, std::span<PathVertex*> walkers) {
    const Occluders* occluders = walk.snapshot.occluders.get();
    Ray rays[walkers_at_once];
    Hits hits;
    for (size_t i = 0; i < walkers.size(); ++i) {
        Ray& ray = walkers[i]->ray;
        ray.t_max = clip(walk.rules.reach, ray.origin, ray.direction, {0, infinity}).high;
        rays[i] = ray;
    }
    hits.instance.fill(-1), hits.t.fill(infinity);
    if (occluders && !occluders->empty()) occluders->closest({rays, walkers.size()}, 0, hits, false);
    for (size_t i = 0; i < walkers.size(); ++i) {
        const float wall = hits.instance[i] >= 0 ? hits.t[i] : infinity;
        fly(walk, *walkers[i], wall, [&] { return occluders->surface(rays[i], hits, static_cast<int>(i)); });
        if (++walkers[i]->flights == max_flights) walkers[i]->walking = false;
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
        for (int i = 0; i < side * side; ++i)
            strata.cumulative.push_back(sum += luminance(square.power) / (side * side));
    for (double& each : strata.cumulative) each /= sum;
    return strata;
}

void trace_light_paths(const Snapshot& snapshot, const RayStrata& strata, const LightPathRules& rules, int64_t first,
                       int64_t count, int64_t total, LightPathResult& result, int64_t step) {
    const std::vector<LightSquare> squares = squares_of(snapshot, rules.reach);
    const Walk walk{snapshot, strata, rules, squares, std::ranges::any_of(snapshot.media, is_endless), result};
    PathVertex walkers[walkers_at_once];
    for (int64_t done = 0; done < count; done += walkers_at_once) {
        const size_t some = static_cast<size_t>(std::min<int64_t>(walkers_at_once, count - done));
        for (size_t i = 0; i < some; ++i)
            walkers[i] = start(walk, first + step * (done + static_cast<int64_t>(i)), total);
        for (;;) {
            PathVertex* walking[walkers_at_once];
            size_t left = 0;
            for (size_t i = 0; i < some; ++i)
                if (walkers[i].walking) walking[left++] = &walkers[i];
            if (left == 0) break;
            fly_all(walk, {walking, left});
        }
        for (size_t i = 0; i < some; ++i) {
            result.hits += walkers[i].flown > 0;
            if (!result.of_stratum.empty())
                result.of_stratum[walkers[i].stratum] += walkers[i].flown * walkers[i].flown;
        }
    }
}
}
