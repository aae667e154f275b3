// Front-to-back compositing of fog stretches and surfaces for sixteen camera rays at once.
#include "render/samples.h"

#include "base/random.h"
#include "render/fog_reach.h"

namespace tyndall {
namespace {
constexpr int most_layers = 64;
enum : uint32_t { use_id = 1, use_jitter = 2, use_soft_light = 3 };

// A ray on its way: where its next stretch starts and how much of what follows reaches the eye.
struct Path {
    Ray ray;            // from the eye or the last BLEND surface
    float skip = 0;     // surfaces nearer than this are behind: the near plane, or the surface just left
    float through = 1;  // share of light that gets through fog and BLEND surfaces so far
    uint32_t seed = 0;  // of the pixel in this frame
    uint32_t shift = 0; // of its jitter
    SamplePlace place;
    vec2 screen{0}; // position in the picture, 0..1
    int lane = 0;
    int instance = -1, triangle = -1; // just left: at grazing angles rounding may hit it again
};

struct Stretches { // of the paths still on their way, packed
    Path path[16];
    int count = 0;
    Hits hits;
    float length[16];
    Ray tested[16]; // the rays as given to the occluders

    bool hit(int i) const { return hits.instance[i] >= 0; }
    bool hit_again(int i) const {
        return hit(i) && hits.instance[i] == path[i].instance && hits.triangle[i] == path[i].triangle;
    }
};

// Steps off a surface: beyond the rounding error of the point, below anything visible.
float surface_skip(vec3 point, float travelled) { return std::max(shadow_offset(point), 4e-6f * travelled); }

// Interleaved gradient noise (Jimenez 2014), in 32 bits: neighbouring pixels get numbers far apart, so that what is
// left of the step pattern is fine grain instead of clumps. Moves by the golden ratio from frame to frame.
uint32_t interleaved(ivec2 pixel, int frame) {
    const double inner = 0.06711056 * pixel.x + 0.00583715 * pixel.y;
    const double value = 52.9829189 * (inner - std::floor(inner));
    return static_cast<uint32_t>((value - std::floor(value)) * 0x1p32) + static_cast<uint32_t>(frame) * 0x9e3779b9u;
}

// Sample `sample` of a shifted van der Corput sequence: the samples of a pixel are spread evenly over [0,1). Moved at
// random within half its stratum, so that regular steps do not beat with regular shadows.
float stratified(int sample, uint32_t shift) { return to_unit(reverse_bits(static_cast<uint32_t>(sample)) + shift); }

Path camera_path(const View& view, ivec2 pixel, int sample, int lane, PixelSample& result) {
    const vec2 position = sample_position(view, pixel, sample);
    const vec2 off = position - (vec2(pixel) + 0.5f);
    result.off_center = glm::dot(off, off);

    Path path;
    path.ray = camera_ray(view.camera, view.size, position);
    const float along = std::max(glm::dot(path.ray.direction, view.camera.forward), 1e-6f);
    path.skip = view.camera.near / along;
    const uint32_t index =
        static_cast<uint32_t>(pixel.y) * static_cast<uint32_t>(view.size.x) + static_cast<uint32_t>(pixel.x);
    path.seed = hash(index, view.frame, view.seed);
    path.place = sample_place(view, pixel, sample);
    path.shift = interleaved(pixel, view.frame) + hash(view.seed, use_jitter);
    path.screen = position / vec2(view.size);
    path.lane = lane;
    return path;
}

void find_surfaces(const Snapshot& snapshot, int layer, Stretches& s) {
    for (int i = 0; i < s.count; ++i) {
        const Path& path = s.path[i];
        s.tested[i] = {path.ray.at(path.skip), path.ray.direction, std::max(path.ray.t_max - path.skip, 0.0f)};
    }
    s.hits.instance.fill(-1);
    if (snapshot.occluders && !snapshot.occluders->empty())
        snapshot.occluders->closest({s.tested, static_cast<size_t>(s.count)}, 0, s.hits, layer == 0);
    for (int i = 0; i < s.count; ++i)
        s.length[i] = s.hit(i) ? s.path[i].skip + s.hits.t[i] : fog_reach(snapshot.media, s.path[i].ray);
}

void add_fog(const FrameTracer& tracer, int layer, int sample, Stretches& s, std::span<PixelSample> samples,
             std::span<vec3> per_light) {
    const size_t lights = per_light.empty() ? 0 : tracer.snapshot.lights.size();
    Ray rays[16];
    uint32_t ids[16];
    float jitter[16];
    SamplePlace places[16];
    Scatter scatter[16];
    for (int i = 0; i < s.count; ++i) {
        rays[i] = {s.path[i].ray.origin, s.path[i].ray.direction, s.length[i]};
        ids[i] = hash(s.path[i].seed, sample, layer, use_id);
        places[i] = s.path[i].place;
        const uint32_t within = hash(ids[i], use_jitter) / static_cast<uint32_t>(2 * tracer.view.pixel_samples);
        jitter[i] = stratified(sample, s.path[i].shift + static_cast<uint32_t>(layer) * 0x9e3779b9u + within);
    }

    std::vector<vec3> light_parts(lights * s.count, vec3(0));
    const size_t count = static_cast<size_t>(s.count);
    tracer.scatter({{rays, count}, {ids, count}, light_parts, {jitter, count}, {places, count}}, {scatter, count});

    for (int i = 0; i < s.count; ++i) {
        Path& path = s.path[i];
        PixelSample& result = samples[path.lane];
        result.color += path.through * scatter[i].radiance;
        result.inscatter += path.through * scatter[i].radiance;
        result.transmittance *= scatter[i].transmittance;
        result.validity = std::min(result.validity, scatter[i].validity);
        result.steps += scatter[i].steps;
        for (size_t l = 0; l < lights; ++l)
            per_light[path.lane * lights + l] += path.through * light_parts[i * lights + l];
        path.through *= scatter[i].transmittance;
    }
}

// Light of the surfaces met; `surfaces` and the results are packed like the stretches that hit one.
void add_surfaces(const FrameTracer& tracer, int layer, int sample, const Stretches& s,
                  std::span<const SurfacePoint> surfaces, std::span<const int> which, std::span<PixelSample> samples,
                  std::span<vec3> per_light) {
    const size_t lights = per_light.empty() ? 0 : tracer.snapshot.lights.size();
    vec2 u[16] = {};
    vec3 radiance[16];
    const bool soft = std::ranges::any_of(tracer.snapshot.lights, is_soft);
    for (size_t k = 0; soft && k < which.size(); ++k) {
        const Sample2 random = sample2(sample, hash(s.path[which[k]].seed, layer, use_soft_light));
        u[k] = {random.x, random.y};
    }
    std::vector<vec3> light_parts(lights * which.size(), vec3(0));
    shade_surfaces(tracer.snapshot, tracer.light_depths, surfaces, {u, which.size()}, {radiance, which.size()},
                   lights ? &light_parts : nullptr);

    for (size_t k = 0; k < which.size(); ++k) {
        const Path& path = s.path[which[k]];
        const float share = path.through * surfaces[k].alpha;
        samples[path.lane].color += share * radiance[k];
        for (size_t l = 0; l < lights; ++l) per_light[path.lane * lights + l] += share * light_parts[k * lights + l];
    }
}

void add_background(const FrameTracer& tracer, const Path& path, PixelSample& result) {
    result.color += path.through * background_radiance(tracer.snapshot.background, path.ray.direction, path.screen);
    result.alpha = 1 - path.through;
}

// Ends the paths at opaque surfaces and moves the others to the far side of theirs; true while any is left.
bool advance(const FrameTracer& tracer, std::span<const SurfacePoint> surfaces, std::span<const int> which,
             Stretches& s, std::span<PixelSample> samples) {
    int left = 0;
    for (size_t k = 0; k < which.size(); ++k) {
        Path path = s.path[which[k]];
        const float t = s.length[which[k]];
        if (surfaces[k].alpha >= 1) {
            samples[path.lane].alpha = 1;
            samples[path.lane].depth = planar_depth(tracer.view.camera, path.ray, t);
            continue;
        }
        path.through *= 1 - surfaces[k].alpha;
        path.ray.origin = path.ray.at(t);
        path.ray.t_max -= t;
        path.skip = surface_skip(path.ray.origin, t);
        path.instance = s.hits.instance[which[k]], path.triangle = s.hits.triangle[which[k]];
        s.path[left++] = path;
    }
    s.count = left;
    return left > 0;
}
}

bool PixelSample::finite() const {
    return is_finite(color) && is_finite(inscatter) && std::isfinite(alpha + transmittance + validity);
}

void trace_samples(const FrameTracer& tracer, std::span<const ivec2> pixels, int sample, std::span<PixelSample> samples,
                   std::span<vec3> per_light) {
    Stretches s;
    s.count = static_cast<int>(pixels.size());
    for (int i = 0; i < s.count; ++i) {
        samples[i] = {};
        s.path[i] = camera_path(tracer.view, pixels[i], sample, i, samples[i]);
    }
    std::fill(per_light.begin(), per_light.end(), vec3(0));

    for (int layer = 0; layer < most_layers; ++layer) {
        find_surfaces(tracer.snapshot, layer, s);
        add_fog(tracer, layer, sample, s, samples, per_light);

        SurfacePoint surfaces[16];
        int which[16];
        size_t met = 0;
        for (int i = 0; i < s.count; ++i) {
            if (!s.hit(i)) {
                add_background(tracer, s.path[i], samples[s.path[i].lane]);
                continue;
            }
            surfaces[met] = tracer.snapshot.occluders->surface(s.tested[i], s.hits, i);
            if (s.hit_again(i)) surfaces[met].alpha = 0;
            if (layer + 1 == most_layers) surfaces[met].alpha = 1;
            which[met++] = i;
        }
        if (met == 0) return;
        add_surfaces(tracer, layer, sample, s, {surfaces, met}, {which, met}, samples, per_light);
        if (!advance(tracer, {surfaces, met}, {which, met}, s, samples)) return;
    }
}
}
