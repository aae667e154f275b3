// Camera rays of modes that shade surfaces themselves: the mode says what the light is, the renderer what covers what.
#include "render/frame/camera_paths.h"

namespace tyndall {
namespace {
// One whole ray for each sample, from the eye to the far plane.
void add_light(const FrameTracer& tracer, PathPacket& s, std::span<PixelSample> samples, std::span<vec3> per_light) {
    const size_t count = static_cast<size_t>(s.count);
    Ray rays[16];
    float near[16];
    Scatter scatter[16];
    for (size_t i = 0; i < count; ++i) rays[i] = s.path[i].ray, near[i] = s.path[i].skip;
    const RayNumbers numbers = ray_numbers(tracer.view, 0, s);
    tracer.scatter({.rays = {rays, count},
                    .ids = {numbers.ids, count},
                    .per_light = per_light,
                    .jitter = {numbers.jitter, count},
                    .places = {numbers.places, count},
                    .clip_near = {near, count},
                    .positions = {numbers.positions, count}},
                   {scatter, count});

    for (size_t i = 0; i < count; ++i) {
        PixelSample& result = samples[i];
        result.color = scatter[i].radiance + scatter[i].surface;
        result.inscatter = scatter[i].radiance;
        result.transmittance = scatter[i].transmittance;
        result.validity = scatter[i].validity;
        result.steps = scatter[i].steps;
        s.path[i].through = scatter[i].transmittance;
    }
}
}

void follow_own_paths(const FrameTracer& tracer, PathPacket& s, std::span<PixelSample> samples,
                      std::span<vec3> per_light) {
    add_light(tracer, s, samples, per_light);

    // What covers the background, and the depth.
    for (int layer = 0; layer < max_layers; ++layer) {
        find_surfaces(tracer.snapshot, layer, s);
        for (int i = 0; i < s.count; ++i)
            if (!s.hit(i)) samples[s.path[i].lane].alpha = 1 - s.path[i].through;
        const SurfacesMet met = surfaces_met(tracer.snapshot, layer, s);
        if (!advance(tracer.view, met, s, samples)) return;
    }
}
}
