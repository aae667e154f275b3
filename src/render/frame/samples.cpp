// Front-to-back compositing of fog segments and surfaces for sixteen camera rays at once.
#include "render/frame/samples.h"

#include "base/clock.h"
#include "base/random.h"
#include "render/frame/camera_paths.h"
#include "render/frame/channels.h"
#include "scene/light.h"
#include "trace/mattes.h"
#include "trace/snapshot.h"
#include "trace/transmittance/light_depth.h"
#include "trace/view.h"
#include "volume/medium.h"
#include "volume/rays/fog_reach.h"

#include <algorithm>
#include <atomic>

namespace tyndall {
namespace {
// Distance to the end of the fog along a ray, in any channel.
float reach_of(const FrameTracer& tracer, const Ray& ray) {
    float reach = fog_reach(tracer.snapshot.media, ray);
    for (const Prepared& channel : tracer.prepared.channels)
        reach = std::max(reach, fog_reach(channel.channel->media, ray));
    return reach;
}

void add_fog(const FrameTracer& tracer, int layer, PathPacket& s, std::span<PixelSample> samples,
             std::span<vec3> parts) {
    const size_t part_count = parts.size() / samples.size();
    Ray rays[16];
    Scatter scatter[16];
    bool open[16];
    for (int i = 0; i < s.count; ++i) {
        const Ray& ray = s.path[i].ray;
        open[i] = !s.hit(i);
        rays[i] = {ray.origin, ray.direction, open[i] ? reach_of(tracer, ray) : s.length[i]};
    }

    const RayInputs inputs = ray_inputs(tracer.view, layer, s);
    const size_t count = static_cast<size_t>(s.count);
    std::vector<vec3> fog_parts(part_count * count, vec3(0));
    const RayBatch batch{.rays = {rays, count},
                         .ids = {inputs.ids, count},
                         .parts = fog_parts,
                         .jitter = {inputs.jitter, count},
                         .sample_indices = {inputs.sample_indices, count},
                         .positions = {inputs.positions, count},
                         .open = {open, count}};
    tyndall::scatter(tracer, batch, {scatter, count});

    for (size_t i = 0; i < count; ++i) {
        Path& path = s.path[i];
        PixelSample& result = samples[path.lane];
        result.inscatter += path.throughput * scatter[i].radiance;
        path.fog *= scatter[i].transmittance * scatter[i].tint;
        result.transmittance = mean_component(path.fog), result.channels = path.fog;
        result.validity = std::min(result.validity, scatter[i].validity);
        result.steps += scatter[i].steps;
        for (size_t p = 0; p < part_count; ++p)
            parts[static_cast<size_t>(path.lane) * part_count + p] += path.throughput * fog_parts[i * part_count + p];
        path.throughput *= scatter[i].transmittance * scatter[i].tint;
    }
}

// Adds the light of the surfaces hit.
void add_surfaces(const FrameTracer& tracer, int layer, const PathPacket& s, const SurfaceHits& hits,
                  std::span<PixelSample> samples) {
    const size_t points = static_cast<size_t>(tracer.light_points);
    std::vector<vec2> u(hits.count * points);
    vec3 radiance[16];
    const bool soft =
        tracer.snapshot.environment || tracer.prepared.emitters || std::ranges::any_of(tracer.snapshot.lights, is_soft);
    for (size_t k = 0; soft && k < hits.count; ++k) {
        const Path& path = s.path[hits.which[k]];
        for (size_t p = 0; p < points; ++p) {
            const uint32_t index = path.sample.index * static_cast<uint32_t>(points) + static_cast<uint32_t>(p);
            const Sample2 random = sample2(index, hash(path.seed, layer, use_soft_light));
            u[k * points + p] = {random.x, random.y};
        }
    }
    shade(tracer.snapshot, tracer.prepared, {hits.points, hits.count}, u, {radiance, hits.count});

    for (size_t k = 0; k < hits.count; ++k) {
        const Path& path = s.path[hits.which[k]];
        if (is_matte(tracer.snapshot, hits.points[k].instance))
            samples[path.lane].holdout += mean_component(path.throughput) * hits.points[k].alpha;
        else
            samples[path.lane].surface += path.throughput * hits.points[k].alpha * radiance[k];
    }
}

void add_background(const FrameTracer& tracer, const Path& path, PixelSample& result) {
    result.background +=
        path.throughput * background_radiance(tracer.snapshot.background, path.ray.direction, path.screen);
    result.alpha =
        std::max(1 - mean_component(path.throughput) - result.holdout, 0.0f); // rounding may make it negative
}
}

bool PixelSample::finite() const {
    return is_finite(color()) && is_finite(inscatter) && std::isfinite(alpha + transmittance + validity);
}

namespace {
void trace_shared_paths(const FrameTracer& tracer, PathPacket& s, std::span<PixelSample> samples,
                        std::span<vec3> parts) {
    for (int layer = 0; layer < max_layers; ++layer) {
        find_surfaces(tracer.snapshot, layer, s);
        add_fog(tracer, layer, s, samples, parts);
        for (int i = 0; i < s.count; ++i)
            if (!s.hit(i)) add_background(tracer, s.path[i], samples[s.path[i].lane]);

        const SurfaceHits hits = surface_hits(tracer.snapshot, layer, s);
        if (hits.count == 0) return;
        add_surfaces(tracer, layer, s, hits, samples);
        if (!advance(tracer.view, hits, s, samples)) return;
    }
}
}

FrameTracer FrameTracer::with(const View& other) const {
    return {other, snapshot, prepared, surfaces, light_points, covered, fog_seconds};
}

FrameTracer frame_tracer(const Mode& mode, const View& view, const Snapshot& snapshot, const Settings& settings,
                         const Prepared& prepared) {
    return {view, snapshot, prepared, mode.surfaces, settings.terms.light_points};
}

void scatter(const FrameTracer& tracer, const RayBatch& batch, std::span<Scatter> results) {
    if (!tracer.fog_seconds) return tracer.prepared.scatter(batch, results);
    const double start = steady_seconds();
    tracer.prepared.scatter(batch, results);
    tracer.fog_seconds->fetch_add(steady_seconds() - start, std::memory_order_relaxed);
}

namespace {
void trace_packet(const FrameTracer& tracer, PathPacket& s, std::span<PixelSample> samples, std::span<vec3> parts) {
    if (tracer.surfaces == Surfaces::own)
        trace_own_paths(tracer, s, samples, parts);
    else
        trace_shared_paths(tracer, s, samples, parts);
}

// Traces the paths of a packet that show one moment through its scene; adds the light of its lights to the frame's
// layers.
void trace_moment(const FrameTracer& tracer, const PathPacket& all, int moment, std::span<PixelSample> samples,
                  std::span<vec3> parts) {
    const Prepared& prepared = tracer.prepared.moments[static_cast<size_t>(moment)];
    const Snapshot& snapshot = (*tracer.snapshot.moments)[static_cast<size_t>(moment)];
    PathPacket s;
    PixelSample own[16];
    int lanes[16];
    for (int i = 0; i < all.count; ++i)
        if (all.path[i].moment == moment) {
            const int lane = all.path[i].lane;
            s.path[s.count] = all.path[i], s.path[s.count].lane = s.count;
            own[s.count] = samples[static_cast<size_t>(lane)], lanes[s.count++] = lane;
        }
    const size_t count = static_cast<size_t>(s.count), lights = prepared.layer_of_light.size();
    const size_t part_count = parts.size() / samples.size(), own_count = part_count == 0 ? 0 : lights + other_lights;
    std::vector<vec3> own_parts(count * own_count, vec3(0));
    const FrameTracer at_moment{tracer.view,         snapshot,       prepared,          tracer.surfaces,
                                tracer.light_points, tracer.covered, tracer.fog_seconds};
    trace_packet(at_moment, s, {own, count}, own_parts);

    for (size_t i = 0; i < count; ++i) {
        const size_t lane = static_cast<size_t>(lanes[i]);
        samples[lane] = own[i];
        for (size_t p = 0; p < own_count; ++p) {
            const size_t layer =
                p < lights ? static_cast<size_t>(prepared.layer_of_light[p]) : part_count - other_lights + (p - lights);
            parts[lane * part_count + layer] += own_parts[i * own_count + p];
        }
    }
}

void trace_moments(const FrameTracer& tracer, const PathPacket& s, std::span<PixelSample> samples,
                   std::span<vec3> parts) {
    for (int i = 0; i < s.count; ++i) {
        const int moment = s.path[i].moment;
        const auto is_same = [&](const Path& path) { return path.moment == moment; };
        if (std::none_of(s.path, s.path + i, is_same)) trace_moment(tracer, s, moment, samples, parts);
    }
}
}

void trace_samples(const FrameTracer& tracer, std::span<const ivec2> pixels, int sample, std::span<PixelSample> samples,
                   std::span<vec3> parts) {
    std::fill(parts.begin(), parts.end(), vec3(0));
    PathPacket s;
    start_paths(tracer.view, !tracer.prepared.moments.empty(), pixels, sample, s, samples);
    if (tracer.prepared.moments.empty())
        trace_packet(tracer, s, samples, parts);
    else
        trace_moments(tracer, s, samples, parts);

    const size_t part_count = parts.size() / pixels.size();
    for (size_t i = 0; i < pixels.size(); ++i) {
        PixelSample& result = samples[i];
        if (tracer.covered) result.alpha = 1 - result.holdout;
        if (!tracer.view.background) result.background = vec3(0);
        result.surface *= result.weight, result.background *= result.weight, result.inscatter *= result.weight;
        for (vec3& part : parts.subspan(i * part_count, part_count)) part *= result.weight;
    }
}
}
