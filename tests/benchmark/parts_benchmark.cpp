// A frame of the march against the sum of its parts: the same steps, density samples, shadow rays and look-ups of
// light-side depth, each kind alone over all points of the frame. `ratio` is what the frame takes over what they take.
//
//     TYNDALL_SCENE=scenes/pillars.json TYNDALL_QUALITY=final tyndall_benchmark --benchmark_filter=march_and_its_parts
#include "base/clock.h"
#include "base/simd/isa.h"
#include "integrate/march_steps.h"
#include "modes/mode.h"
#include "modes/settings.h"
#include "scene/scene.h"
#include "trace/lights/light_ray.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"
#include "trace/transmittance/light_depth.h"
#include "trace/view.h"
#include "volume/medium.h"
#include "volume/rays/fog_reach.h"

#include <benchmark/benchmark.h>

#include <cstdlib>

namespace {
using namespace tyndall;

std::string option(const char* name, const char* otherwise) {
    const char* value = std::getenv(name);
    return value ? value : otherwise;
}

// Sixteen points of a tile at one step.
struct Points {
    alignas(64) float x[16] = {}, y[16] = {}, z[16] = {};
    alignas(64) int32_t active[16] = {};
};

struct Tile {
    std::vector<Ray> rays;
    std::vector<uint32_t> ids;
};

// Camera rays of every fourth tile of 4×4 pixels, up to the first surface.
std::vector<Tile> tiles_of(const View& view, const Snapshot& snapshot) {
    std::vector<Tile> tiles;
    for (int y = 0; y < view.size.y; y += 8)
        for (int x = 0; x < view.size.x; x += 8) {
            Tile& tile = tiles.emplace_back();
            for (int i = 0; i < 16; ++i) {
                tile.rays.push_back(camera_ray(view.camera, view.size, vec2(x + i % 4, y + i / 4) + 0.5f));
                tile.ids.push_back(static_cast<uint32_t>(16 * tiles.size()) + static_cast<uint32_t>(i));
            }
            Hits hits;
            hits.instance.fill(-1);
            if (snapshot.occluders && !snapshot.occluders->empty()) snapshot.occluders->closest(tile.rays, 0, hits);
            for (size_t i = 0; i < 16; ++i)
                tile.rays[i].t_max = hits.instance[i] >= 0 ? hits.t[i] : fog_reach(snapshot.media, tile.rays[i]);
        }
    return tiles;
}

void append_points(const MarchSteps& rule, const Snapshot& snapshot, const Tile& tile, std::vector<Points>& points) {
    static std::vector<Step> steps;
    const size_t first = points.size();
    for (size_t ray = 0; ray < 16; ++ray) {
        steps.clear();
        append_march_steps(rule, snapshot, tile.rays[ray], steps);
        if (points.size() < first + steps.size()) points.resize(first + steps.size());
        for (size_t k = 0; k < steps.size(); ++k) {
            const vec3 at = tile.rays[ray].at(0.5f * (steps[k].low + steps[k].high));
            Points& p = points[first + k];
            p.x[ray] = at.x, p.y[ray] = at.y, p.z[ray] = at.z, p.active[ray] = -1;
        }
    }
}

void trace_shadows(const Occluders& occluders, const Light& light, const Points& points, float* share) {
    Occluders::ShadowRays rays;
    for (size_t i = 0; i < 16; ++i) {
        const vec3 at(points.x[i], points.y[i], points.z[i]);
        const Ray ray = ray_to_light(light, at, vec2(0.5f));
        rays.ox[i] = at.x, rays.oy[i] = at.y, rays.oz[i] = at.z;
        rays.dx[i] = ray.direction.x, rays.dy[i] = ray.direction.y, rays.dz[i] = ray.direction.z;
        rays.t_min[i] = 0, rays.t_max[i] = ray.t_max, rays.active[i] = points.active[i];
    }
    occluders.transmission(rays, share);
}

template<class Body> double seconds_of(const Body& body) {
    const double start = steady_seconds();
    body();
    return steady_seconds() - start;
}

void march_and_its_parts(benchmark::State& state) {
    set_isa(option("TYNDALL_ISA", "auto"));
    const Scene scene = load_scene(option("TYNDALL_SCENE", "scenes/window.json"));
    const Snapshot snapshot = make_snapshot(scene, moment_of(scene, 1));
    Settings settings = settings_for(quality_named(option("TYNDALL_QUALITY", "final")));
    settings.march.visibility = Visibility::rays;
    View view;
    view.camera = camera_at(scene, find_camera(scene, ""), snapshot.seconds);
    const std::vector<Tile> tiles = tiles_of(view, snapshot);
    const MarchSteps rule = march_steps(settings.march, snapshot.lights);
    std::vector<LightDepth> depths;
    for (const Light& light : snapshot.lights)
        depths.push_back(make_light_depth(snapshot, light, settings.terms.light, settings.terms.light_resolution));
    const ScatterFunction scatter = find_mode("march").prepare(view, snapshot, settings, nullptr);

    double frame = 0, placing = 0, density = 0, shadows = 0, light = 0, samples = 0;
    alignas(64) float values[16];
    std::vector<Points> points;
    for (auto _ : state) {
        frame += seconds_of([&] {
            Scatter results[16];
            for (const Tile& tile : tiles) scatter({.rays = tile.rays, .ids = tile.ids}, results);
            benchmark::DoNotOptimize(results[0].radiance.x);
        });
        points.clear();
        placing += seconds_of([&] {
            for (const Tile& tile : tiles) append_points(rule, snapshot, tile, points);
        });
        density += seconds_of([&] {
            for (const Points& p : points)
                for (const Medium& medium : snapshot.media)
                    densities(medium, p.x, p.y, p.z, values), benchmark::DoNotOptimize(values[0]);
        });
        shadows += seconds_of([&] {
            for (const Points& p : points)
                for (const Light& source : snapshot.lights)
                    trace_shadows(*snapshot.occluders, source, p, values), benchmark::DoNotOptimize(values[0]);
        });
        light += seconds_of([&] {
            for (const Points& p : points)
                for (const LightDepth& depth : depths)
                    light_depths(depth, p.x, p.y, p.z, p.active, values), benchmark::DoNotOptimize(values[0]);
        });
        for (const Points& p : points)
            for (const int32_t active : p.active) samples += active != 0;
    }
    const double times = static_cast<double>(state.iterations());
    state.counters["samples"] = samples / times;
    for (const auto& [name, seconds] : {std::pair{"frame_ms", frame},
                                        {"placing_ms", placing},
                                        {"density_ms", density},
                                        {"shadows_ms", shadows},
                                        {"light_ms", light}})
        state.counters[name] = 1000 * seconds / times;
    state.counters["ratio"] = frame / (placing + density + shadows + light);
    set_isa("auto");
}
BENCHMARK(march_and_its_parts)->Unit(benchmark::kMillisecond);
}
