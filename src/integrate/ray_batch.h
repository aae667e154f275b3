// What a technique is asked for: the light along up to 16 neighbouring camera rays.
#pragma once
#include "base/math.h"
#include "trace/sampling/sample_place.h"

#include <cstdint>
#include <functional>
#include <span>

namespace tyndall {
// What the fog does to one camera ray up to its t_max.
struct Scatter {
    vec3 radiance{0};        // light scattered and emitted towards the eye
    float transmittance = 1; // share of what lies behind that comes through
    float validity = 1;      // 0 where the mode knows itself wrong
    int steps = 0;           // evaluations spent, for statistics
    vec3 surface{0};         // of a mode with Surfaces::own: light of surfaces and background, through the fog
};

// Up to 16 neighbouring rays (4×4 pixels) of one pixel sample.
struct RayBatch {
    std::span<const Ray> rays{};
    std::span<const uint32_t> ids{};       // a number per ray, unique to pixel and sample: seeds random choices
    std::span<vec3> per_light{};           // empty, or rays × lights: the part of radiance from each light
    std::span<const float> jitter{};       // per ray in [0,1), stratified over the samples of a pixel; empty = ½
    std::span<const SamplePlace> places{}; // per ray: its pixel's low-discrepancy sequence; empty = none, take ids
    std::span<const float>
        clip_near{}; // for Surfaces::own, per ray: nearer surfaces are cut away (fog is not); empty = 0
    std::span<const vec2> positions{}; // of the rays in the picture, in pixels from the upper left; empty = unknown
    std::span<const bool> open{};      // per ray: no surface ends it, but the fog; empty = unknown
};
using ScatterFunction = std::function<void(const RayBatch&, std::span<Scatter>)>;
}
