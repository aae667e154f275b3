// Camera paths: where they start, what they hit, how they continue.
#include "render/frame/camera_paths.h"

#include "base/random.h"
#include "scene/lights/area_shape.h"
#include "trace/lights/faces.h"
#include "trace/snapshot.h"
#include "trace/view.h"

#include <algorithm>

namespace tyndall {
namespace {
// Sample `sample` of a van der Corput sequence shifted by `shift`: the samples of a batch are stratified over [0,1).
// The shift includes a random offset within half a stratum, so that regular steps do not alias with regular shadows.
float stratified(uint32_t sample, uint32_t shift) { return to_unit(reverse_bits(sample) + shift); }

Path camera_path(const View& view, bool in_moments, ivec2 pixel, int sample, int lane, PixelSample& result) {
    const auto [position, weight] = sample_point(view, pixel, sample);
    const vec2 off = position - (vec2(pixel) + 0.5f);
    result.off_center = glm::dot(off, off), result.weight = weight;

    Path path;
    path.sample = sample_index(view, pixel, sample);
    if (in_moments) path.moment = moment_at(view, pixel, sample);
    const Camera& camera = in_moments ? view.shutter->cameras[static_cast<size_t>(path.moment)] : view.camera;
    path.ray = sample_ray(view, camera, position, path.sample);
    const float along = std::max(glm::dot(path.ray.direction, camera.forward), 1e-6f);
    path.skip = camera.near / along;
    path.screen = position / vec2(view.size), path.position = position;
    path.lane = lane;

    // Each batch has its own random numbers.
    const uint32_t index =
        static_cast<uint32_t>(pixel.y) * static_cast<uint32_t>(view.size.x) + static_cast<uint32_t>(pixel.x);
    path.seed = hash(index, view.frame, view.seed);
    path.shift = jitter_bits(view.jitter, pixel, view.frame, view.seed) + hash(view.seed, use_jitter);
    const auto [batch, at, count] = batch_sample(view, pixel, sample);
    path.samples = count;
    if (batch > 0) {
        path.seed = hash(path.seed, batch);
        path.shift += hash(path.seed, use_jitter);
    }
    return path;
}
}

void start_paths(const View& view, bool in_moments, std::span<const ivec2> pixels, int sample, PathPacket& s,
                 std::span<PixelSample> samples) {
    s.count = static_cast<int>(pixels.size());
    for (int i = 0; i < s.count; ++i) {
        samples[i] = {};
        s.path[i] = camera_path(view, in_moments, pixels[i], sample, i, samples[i]);
    }
}

namespace {
// Ends paths at visible area lights in front of the surfaces they hit.
void find_faces(const Snapshot& snapshot, PathPacket& s) {
    for (int i = 0; i < s.count; ++i) {
        const FaceHit face = visible_face(snapshot, s.tested[i]);
        if (face.light < 0 || s.path[i].skip + face.distance >= s.length[i]) continue;
        s.face[i] = face.light, s.length[i] = s.path[i].skip + face.distance;
        s.hits.instance[i] = -1;
    }
}

// The face of an area light as a surface that only emits.
SurfacePoint face_point(const Light& light, vec3 position) {
    SurfacePoint point;
    point.position = position, point.normal = point.face_normal = light.area->normal;
    point.base_color = vec3(0), point.emission = radiance_of(light) * face_texture(*light.area, position);
    return point;
}
}

void find_surfaces(const Snapshot& snapshot, int layer, PathPacket& s) {
    for (int i = 0; i < s.count; ++i) {
        const Path& path = s.path[i];
        s.tested[i] = {path.ray.at(path.skip), path.ray.direction, std::max(path.ray.t_max - path.skip, 0.0f)};
    }
    s.hits.instance.fill(-1);
    if (snapshot.occluders && !snapshot.occluders->empty())
        snapshot.occluders->closest({s.tested, static_cast<size_t>(s.count)}, 0, s.hits, layer == 0);
    std::fill_n(s.face, s.count, -1);
    for (int i = 0; i < s.count; ++i) s.length[i] = s.hit(i) ? s.path[i].skip + s.hits.t[i] : s.path[i].ray.t_max;
    if (shows_faces(snapshot)) find_faces(snapshot, s);
}

SurfaceHits surface_hits(const Snapshot& snapshot, int layer, const PathPacket& s) {
    SurfaceHits hits;
    for (int i = 0; i < s.count; ++i) {
        if (!s.hit(i)) continue;
        SurfacePoint& point = hits.points[hits.count];
        if (s.face[i] >= 0) {
            point = face_point(snapshot.lights[static_cast<size_t>(s.face[i])], s.path[i].ray.at(s.length[i]));
            hits.which[hits.count++] = i;
            continue;
        }
        point = snapshot.occluders->surface(s.tested[i], s.hits, i);
        if (s.hit_again(i)) point.alpha = 0;
        if (layer + 1 == max_layers) point.alpha = 1;
        hits.which[hits.count++] = i;
    }
    return hits;
}

bool advance(const View& view, const SurfaceHits& hits, PathPacket& s, std::span<PixelSample> samples) {
    int left = 0;
    for (size_t k = 0; k < hits.count; ++k) {
        const int i = hits.which[k];
        Path path = s.path[i];
        const float t = s.length[i];
        if (hits.points[k].alpha >= 1) {
            samples[path.lane].alpha = 1 - samples[path.lane].holdout;
            samples[path.lane].depth = planar_depth(view.camera, path.ray, t);
            continue;
        }
        path.throughput *= 1 - hits.points[k].alpha;
        path.ray.origin = path.ray.at(t);
        path.ray.t_max -= t;
        path.skip = surface_skip(path.ray.origin, t);
        path.instance = s.hits.instance[i], path.triangle = s.hits.triangle[i];
        s.path[left++] = path;
    }
    s.count = left;
    return left > 0;
}

RayInputs ray_inputs(const View& view, int layer, const PathPacket& s) {
    RayInputs inputs;
    for (int i = 0; i < s.count; ++i) {
        const Path& path = s.path[i];
        const uint32_t id = hash(path.seed, path.sample.index, layer, use_id);
        const uint32_t within = hash(id, use_jitter) / (2 * path.samples);
        inputs.ids[i] = id;
        const uint32_t shift = path.shift + static_cast<uint32_t>(layer) * 0x9e3779b9u + within;
        inputs.jitter[i] = view.jitter == Jitter::none ? 0.5f : stratified(path.sample.index, shift);
        inputs.positions[i] = path.position;
        inputs.sample_indices[i] = path.sample;
    }
    return inputs;
}

namespace {
// One ray per sample, from the camera to the far plane.
void add_light(const FrameTracer& tracer, PathPacket& s, std::span<PixelSample> samples, std::span<vec3> parts) {
    const size_t count = static_cast<size_t>(s.count);
    Ray rays[16];
    float near[16];
    Scatter scatter[16];
    for (size_t i = 0; i < count; ++i) rays[i] = s.path[i].ray, near[i] = s.path[i].skip;
    const RayInputs inputs = ray_inputs(tracer.view, 0, s);
    const RayBatch batch{.rays = {rays, count},
                         .ids = {inputs.ids, count},
                         .parts = parts,
                         .jitter = {inputs.jitter, count},
                         .sample_indices = {inputs.sample_indices, count},
                         .clip_near = {near, count},
                         .positions = {inputs.positions, count}};
    tyndall::scatter(tracer, batch, {scatter, count});

    for (size_t i = 0; i < count; ++i) {
        PixelSample& result = samples[i];
        result.surface = scatter[i].surface, result.background = scatter[i].background;
        result.inscatter = scatter[i].radiance, result.holdout = scatter[i].holdout;
        result.transmittance = scatter[i].transmittance;
        result.channels = scatter[i].transmittance * scatter[i].tint;
        result.validity = scatter[i].validity;
        result.steps = scatter[i].steps;
        s.path[i].throughput = scatter[i].transmittance * scatter[i].tint;
    }
}

// Traces through surfaces for alpha and depth.
void trace_surfaces(const FrameTracer& tracer, PathPacket& s, std::span<PixelSample> samples) {
    for (int layer = 0; layer < max_layers; ++layer) {
        find_surfaces(tracer.snapshot, layer, s);
        for (int i = 0; i < s.count; ++i)
            if (!s.hit(i))
                samples[s.path[i].lane].alpha =
                    1 - mean_component(s.path[i].throughput) - samples[s.path[i].lane].holdout;
        const SurfaceHits hits = surface_hits(tracer.snapshot, layer, s);
        if (!advance(tracer.view, hits, s, samples)) return;
    }
}
}

void trace_own_paths(const FrameTracer& tracer, PathPacket& s, std::span<PixelSample> samples, std::span<vec3> parts) {
    add_light(tracer, s, samples, parts);
    trace_surfaces(tracer, s, samples);
}

bool has_center_depths(const FrameTracer& tracer) {
    return tracer.view.camera.lens || !tracer.prepared.moments.empty();
}

void center_depths(const FrameTracer& tracer, std::span<const ivec2> pixels, std::span<float> depths) {
    View pinhole = tracer.view;
    pinhole.camera.lens = {}, pinhole.filter = PixelFilter::center;
    pinhole.pixel_samples = pinhole.batches = 1, pinhole.leaves = 0;
    pinhole.allotted = pinhole.edges = nullptr, pinhole.lamps.clear();
    PathPacket s;
    PixelSample samples[16];
    start_paths(pinhole, false, pixels, 0, s, samples);
    trace_surfaces(tracer, s, samples);
    for (size_t i = 0; i < pixels.size(); ++i) depths[i] = samples[i].depth;
}
}
