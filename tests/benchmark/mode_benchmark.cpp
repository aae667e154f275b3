// Fog of a whole picture, surfaces excluded: preparation and all look-ups of a mode at 640×360, one ray per pixel, with
// the first surfaces traced beforehand, and what a mode adds to the finished picture. Frames of moving scenes follow
// one another; `history` keeps what a mode keeps.
//
//     tyndall_benchmark --benchmark_filter=fog_of_picture/froxel
//     TYNDALL_MODES=froxel,march TYNDALL_SCENE=scenes/pillars.json TYNDALL_SET=froxel.tile=4 tyndall_benchmark ...
//     TYNDALL_ISA=avx512 tyndall_benchmark ...
#include "base/isa.h"
#include "base/parallel.h"
#include "modes/mode.h"
#include "scene/scene.h"

#include <benchmark/benchmark.h>

#include <chrono>
#include <cstdlib>
#include <ctime>
#include <sstream>

namespace {
using namespace tyndall;

std::string option(const char* name, const char* otherwise) {
    const char* value = std::getenv(name);
    return value ? value : otherwise;
}

std::vector<std::string> parts_of(const std::string& list, char separator) {
    std::vector<std::string> parts;
    std::istringstream stream(list);
    for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
    return parts;
}

// A picture's camera rays in tiles of 4×4 pixels, each up to the first surface, and a picture of grey surfaces before a
// bright sky.
struct PictureRays {
    std::vector<Ray> rays;
    std::vector<uint32_t> ids;
    std::vector<vec2> positions;
    std::vector<float> jitter;
    Image<vec3> color;
    Image<float> alpha, depth;
};

PictureRays picture_rays(const View& view, const Snapshot& snapshot) {
    PictureRays picture;
    picture.color = Image<vec3>(view.size, vec3(2));
    picture.alpha = Image<float>(view.size, 0), picture.depth = Image<float>(view.size, infinity);
    for (int y = 0; y < view.size.y; y += 4)
        for (int x = 0; x < view.size.x; x += 4)
            for (int i = 0; i < 16; ++i) {
                const vec2 position = vec2(x + i % 4, y + i / 4) + 0.5f;
                picture.rays.push_back(camera_ray(view.camera, view.size, position));
                picture.ids.push_back(static_cast<uint32_t>(picture.ids.size()));
                picture.positions.push_back(position);
                picture.jitter.push_back(static_cast<float>(i) / 16);
            }
    parallel_for(static_cast<int64_t>(picture.rays.size() / 16), [&](int64_t tile) {
        const std::span rays{picture.rays.data() + 16 * tile, 16};
        Hits hits;
        hits.instance.fill(-1);
        if (snapshot.occluders && !snapshot.occluders->empty()) snapshot.occluders->closest(rays, 0, hits);
        Box reach;
        for (const Medium& medium : snapshot.media) reach.grow(medium.world_bounds);
        for (size_t i = 0; i < 16; ++i) {
            const Interval fog = clip(reach, rays[i].origin, rays[i].direction, {0, rays[i].t_max});
            rays[i].t_max = hits.instance[i] >= 0 ? hits.t[i] : std::min(fog.high, 1e6f);
            if (hits.instance[i] < 0) continue;
            const ivec2 pixel(picture.positions[static_cast<size_t>(16 * tile) + i]);
            picture.color.at(pixel.x, pixel.y) = vec3(0.2f), picture.alpha.at(pixel.x, pixel.y) = 1;
            picture.depth.at(pixel.x, pixel.y) = hits.t[i] * glm::dot(rays[i].direction, view.camera.forward);
        }
    });
    return picture;
}

void scatter_picture(const ScatterFunction& scatter, const PictureRays& picture, std::vector<Scatter>& results) {
    parallel_for(static_cast<int64_t>(picture.rays.size() / 16), [&](int64_t tile) {
        const size_t first = static_cast<size_t>(16 * tile);
        const RayBatch batch{std::span(picture.rays).subspan(first, 16),
                             std::span(picture.ids).subspan(first, 16),
                             {},
                             std::span(picture.jitter).subspan(first, 16),
                             {},
                             {},
                             std::span(picture.positions).subspan(first, 16)};
        scatter(batch, std::span(results).subspan(first, 16));
    });
}

double milliseconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

void fog_of_picture(benchmark::State& state, const std::string& name, bool keep) {
    const Scene scene = load_scene(option("TYNDALL_SCENE", "scenes/window.json"));
    Settings settings = settings_for(quality_named(option("TYNDALL_QUALITY", "preview")));
    for (const std::string& assignment : parts_of(option("TYNDALL_SET", ""), ' ')) apply_setting(settings, assignment);
    Snapshot snapshot = make_snapshot(scene, moment_of(scene, 1));
    snapshot.kept = nullptr; // every preparation begins with nothing
    View view;
    view.camera = camera_at(scene, find_camera(scene, ""), snapshot.seconds);
    const PictureRays picture = picture_rays(view, snapshot);
    std::vector<Scatter> results(picture.rays.size());
    const Mode& mode = find_mode(name);

    // Work of all threads: on a busy machine, half of it is what two cores take.
    const auto work = [](std::clock_t from, std::clock_t to) {
        return 1000.0 * static_cast<double>(to - from) / CLOCKS_PER_SEC;
    };
    struct Times {
        double prepare = 0, scatter = 0, post = 0;
    } real, cpu;
    double fastest = 1e9;
    History history;
    for (auto _ : state) {
        const auto start = std::chrono::steady_clock::now();
        const std::clock_t work_start = std::clock();
        const ScatterFunction function = mode.prepare(view, snapshot, settings, keep ? &history : nullptr);
        real.prepare += milliseconds_since(start);
        const auto prepared = std::chrono::steady_clock::now();
        const std::clock_t work_prepared = std::clock();
        scatter_picture(function, picture, results);
        real.scatter += milliseconds_since(prepared);
        const auto scattered = std::chrono::steady_clock::now();
        const std::clock_t work_scattered = std::clock();
        if (mode.prepare_post)
            benchmark::DoNotOptimize(
                mode.prepare_post(view, snapshot, settings)({picture.color, picture.alpha, picture.depth}));
        real.post += milliseconds_since(scattered);
        fastest = std::min(fastest, milliseconds_since(start));
        cpu.prepare += work(work_start, work_prepared), cpu.scatter += work(work_prepared, work_scattered);
        cpu.post += work(work_scattered, std::clock());
    }
    const auto count = static_cast<double>(state.iterations());
    state.counters["prepare_ms"] = real.prepare / count, state.counters["scatter_ms"] = real.scatter / count;
    state.counters["prepare_cpu_ms"] = cpu.prepare / count, state.counters["scatter_cpu_ms"] = cpu.scatter / count;
    if (mode.prepare_post)
        state.counters["post_ms"] = real.post / count, state.counters["post_cpu_ms"] = cpu.post / count;
    state.counters["fastest_ms"] = fastest; // the least disturbed frame
    state.counters["threads"] = thread_count();
}

const bool registered = [] {
    flush_denormals();
    set_isa(option("TYNDALL_ISA", "auto"));
    for (const std::string& name : parts_of(option("TYNDALL_MODES", "froxel,march"), ','))
        for (const bool keep : {false, true})
            benchmark::RegisterBenchmark(("fog_of_picture/" + name + (keep ? "/history" : "")).c_str(), fog_of_picture,
                                         name, keep)
                ->Unit(benchmark::kMillisecond)
                ->UseRealTime();
    return true;
}();
}
