// Fog of a whole picture, surfaces excluded: preparation and all look-ups of a mode, one ray per pixel, and what a mode
// adds to the finished picture. First surfaces are traced beforehand, or for each frame of a moving camera, and counted
// apart. `history` keeps what a mode and a sequence of frames keep; its first frame is not counted.
//
//     tyndall_benchmark --benchmark_filter=fog_of_picture/froxel
//     TYNDALL_MODES=froxel,march TYNDALL_SCENE=scenes/pillars.json TYNDALL_SET=froxel.tile=4 tyndall_benchmark ...
//     TYNDALL_SIZE=1280x720 TYNDALL_MOVE=light,camera tyndall_benchmark ...
//     TYNDALL_SIZE=1280x720 TYNDALL_MOVE=fog TYNDALL_SET=froxel.amortize=on tyndall_benchmark ...
//     TYNDALL_ISA=avx512 tyndall_benchmark ...
#include "base/clock.h"
#include "base/parallel.h"
#include "base/simd/isa.h"
#include "modes/history.h"
#include "modes/mode.h"
#include "modes/settings.h"
#include "scene/camera.h"
#include "scene/light.h"
#include "scene/scene.h"
#include "trace/frame_cache.h"
#include "trace/occlusion/occluders.h"
#include "trace/snapshot.h"
#include "trace/view.h"
#include "volume/bricks/bricks.h"
#include "volume/medium.h"

#include <benchmark/benchmark.h>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <sstream>
#include <stdexcept>

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

// Pixels across and down, from a text like 1280x720; whole tiles of 4×4.
ivec2 size_of(const std::string& text) {
    const std::vector<std::string> sides = parts_of(text, 'x');
    return (ivec2(std::stoi(sides.at(0)), std::stoi(sides.at(1))) + 3) / 4 * 4;
}

vec3 turned(vec3 v, float angle) {
    const float c = std::cos(angle), s = std::sin(angle);
    return {c * v.x + s * v.z, v.y, c * v.z - s * v.x};
}

// Frame by frame suns turn to and fro about the vertical, other lights, the camera and fog from grids sway.
struct Movement {
    bool light = false, camera = false, fog = false;

    static float sway(int frame) { return std::sin(0.1f * static_cast<float>(frame)); }
    void move(int frame, const Snapshot& still, Snapshot& moved) const {
        for (size_t i = 0; light && i < moved.lights.size(); ++i) {
            moved.lights[i].direction = turned(still.lights[i].direction, 0.1f * sway(frame));
            moved.lights[i].position = still.lights[i].position + 0.1f * sway(frame) * vec3(1, 0, 1);
        }
    }
    void move(int frame, const Camera& still, Camera& moved) const {
        if (camera) moved.position = still.position + 0.1f * sway(frame) * still.right;
    }
    // Another grid each time, as frames of a file are.
    void move_fog(int frame, const Snapshot& still, Snapshot& moved) const {
        for (size_t i = 0; fog && i < moved.media.size(); ++i) {
            if (moved.media[i].density.kind != DensityKind::bricks) continue;
            auto bricks = std::make_shared<BrickPool>(*still.media[i].density.bricks);
            const dmat4 to_volume = glm::translate(dmat4(1), -dvec3(bricks->low));
            place(*bricks,
                  glm::translate(dmat4(1), dvec3(0.1 * sway(frame))) * dmat4(bricks->index_to_world) * to_volume);
            moved.media[i].density.bounds = moved.media[i].world_bounds = bricks->bounds;
            moved.media[i].density.bricks = std::move(bricks);
        }
    }
};

Movement movement_of(const std::string& list) {
    Movement movement;
    for (const std::string& part : parts_of(list, ',')) {
        movement.light |= part == "light", movement.camera |= part == "camera", movement.fog |= part == "fog";
        if (part != "light" && part != "camera" && part != "fog")
            throw std::invalid_argument("TYNDALL_MOVE: light, camera, fog");
    }
    return movement;
}

// A picture's camera rays in tiles of 4×4 pixels, each up to the first surface, and a picture of gray surfaces before a
// bright sky.
struct PictureRays {
    std::vector<Ray> rays;
    std::vector<uint32_t> ids;
    std::vector<vec2> positions;
    std::vector<float> jitter;
    Image<vec3> color;
    Image<float> alpha, depth;
};

PictureRays pixel_rays(const View& view, const Snapshot& snapshot) {
    PictureRays picture;
    picture.color = Image<vec3>(view.size, vec3(2));
    picture.alpha = Image<float>(view.size, 0), picture.depth = Image<float>(view.size, infinity);
    const ivec2 tiles = (view.size + 3) / 4;
    const size_t count = 16 * static_cast<size_t>(tiles.x) * static_cast<size_t>(tiles.y);
    picture.rays.resize(count), picture.ids.resize(count);
    picture.positions.resize(count), picture.jitter.resize(count);
    parallel_for(int64_t{tiles.x} * tiles.y, [&](int64_t tile) {
        const std::span rays{picture.rays.data() + 16 * tile, 16};
        for (size_t i = 0; i < 16; ++i) {
            const size_t at = static_cast<size_t>(16 * tile) + i;
            const vec2 position = vec2(4 * (tile % tiles.x) + i % 4, 4 * (tile / tiles.x) + i / 4) + 0.5f;
            rays[i] = camera_ray(view.camera, view.size, position);
            picture.positions[at] = position, picture.ids[at] = static_cast<uint32_t>(at);
            picture.jitter[at] = static_cast<float>(i) / 16;
        }
        Hits hits;
        hits.instance.fill(-1);
        if (snapshot.occluders && !snapshot.occluders->empty()) snapshot.occluders->closest(rays, 0, hits);
        Box reach;
        for (const Medium& medium : snapshot.media) reach.grow(medium.world_bounds);
        for (size_t i = 0; i < 16; ++i) {
            const Interval<float> fog = clip(reach, rays[i].origin, rays[i].direction, {0, rays[i].t_max});
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
        const RayBatch batch{.rays = std::span(picture.rays).subspan(first, 16),
                             .ids = std::span(picture.ids).subspan(first, 16),
                             .jitter = std::span(picture.jitter).subspan(first, 16),
                             .positions = std::span(picture.positions).subspan(first, 16)};
        scatter(batch, std::span(results).subspan(first, 16));
    });
}

// Milliseconds of a stage: that pass, and the work of all threads (on a busy machine, half of it is what two cores
// take).
struct Stage {
    double real = 0, work = 0;

    template<class Body> void time(const Body& body) {
        const double start = steady_seconds();
        const std::clock_t work_start = std::clock();
        body();
        real += 1000 * (steady_seconds() - start);
        work += 1000.0 * static_cast<double>(std::clock() - work_start) / CLOCKS_PER_SEC;
    }
};

void fog_of_picture(benchmark::State& state, const std::string& name, bool keep) {
    const Scene scene = load_scene(option("TYNDALL_SCENE", "scenes/window.json"));
    Settings settings = settings_for(quality_named(option("TYNDALL_QUALITY", "preview")));
    for (const std::string& assignment : parts_of(option("TYNDALL_SET", ""), ' ')) apply_setting(settings, assignment);
    const Movement movement = movement_of(option("TYNDALL_MOVE", ""));
    Snapshot still = make_snapshot(scene, moment_of(scene, 1));
    still.cache = nullptr; // without a history every preparation begins with nothing
    Snapshot snapshot = still;
    View view;
    view.size = size_of(option("TYNDALL_SIZE", "640x360"));
    const Camera camera = camera_at(scene, find_camera(scene, ""), snapshot.seconds);
    view.camera = camera;
    PictureRays picture = pixel_rays(view, snapshot);
    std::vector<Scatter> results(picture.rays.size());
    const Mode& mode = find_mode(name);

    struct Times {
        Stage trace, prepare, scatter, post;
    };
    History history;
    int frame = 0;
    const auto run = [&](Times& times) {
        movement.move(frame, still, snapshot), movement.move(frame, camera, view.camera);
        movement.move_fog(frame, still, snapshot);
        if (keep) snapshot.previous_cache = std::exchange(snapshot.cache, std::make_shared<FrameCache>());
        view.frame = frame++;
        if (movement.camera) times.trace.time([&] { picture = pixel_rays(view, snapshot); });
        ScatterFunction function;
        times.prepare.time([&] { function = mode.prepare(view, snapshot, settings, keep ? &history : nullptr); });
        times.scatter.time([&] { scatter_picture(function, picture, results); });
        if (!mode.prepare_post) return;
        times.post.time([&] {
            benchmark::DoNotOptimize(
                mode.prepare_post(view, snapshot, settings)({picture.color, picture.alpha, picture.depth}));
        });
    };
    const auto fog_time = [](const Times& t) { return t.prepare.real + t.scatter.real + t.post.real; };
    Times first, all;
    if (keep) run(first);
    std::vector<double> frames;
    for (auto _ : state) {
        const double before = fog_time(all);
        run(all);
        frames.push_back(fog_time(all) - before);
    }
    std::sort(frames.begin(), frames.end());
    const auto count = static_cast<double>(state.iterations());
    const auto report = [&](const std::string& stage, const Stage& times) {
        state.counters[stage + "_ms"] = times.real / count, state.counters[stage + "_cpu_ms"] = times.work / count;
    };
    if (movement.camera) report("trace", all.trace);
    report("prepare", all.prepare), report("scatter", all.scatter);
    if (mode.prepare_post) report("post", all.post);
    state.counters["fastest_ms"] = frames.front(); // fog of the least disturbed frame
    state.counters["median_ms"] = frames[frames.size() / 2];
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
