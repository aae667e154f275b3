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
    float transmittance = 1; // share of what lies behind that comes through, the mean of the channels
    float validity = 1;      // 0 where the mode knows itself wrong
    int steps = 0;           // evaluations spent, for statistics
    // Of a mode with Surfaces::own: light of surfaces, and of the background, through the fog.
    vec3 surface{0}, background{0};
    float held = 0; // of such a mode: share of the light from behind the fog that mattes hold out
    vec3 tint{1};   // times the transmittance: that of each channel, which it is the mean of

    vec3 whole() const { return surface + background + radiance; }
};

// Light in fog that is of no single light of the scene: its ambient light, what glows by itself, and what the mode
// knows to have been scattered before without knowing whose it is.
enum class OtherLight : size_t { ambient, emission, multiple };
inline constexpr size_t other_lights = 3;

// The parts of a ray's light in fog: those of the lights, then those of other light.
constexpr size_t part_count(size_t lights) { return lights + other_lights; }

// Up to 16 neighbouring rays (4×4 pixels) of one pixel sample.
struct RayBatch {
    std::span<const Ray> rays{};
    std::span<const uint32_t> ids{};       // a number per ray, unique to pixel and sample: seeds random choices
    std::span<vec3> parts{};               // empty, or rays × part_count(lights): of radiance; the mode adds to them
    std::span<const float> jitter{};       // per ray in [0,1), stratified over the samples of a pixel; empty = ½
    std::span<const SamplePlace> places{}; // per ray: its pixel's low-discrepancy sequence; empty = none, take ids
    std::span<const float>
        clip_near{}; // for Surfaces::own, per ray: nearer surfaces are cut away (fog is not); empty = 0
    std::span<const vec2> positions{}; // of the rays in the picture, in pixels from the upper left; empty = unknown
    std::span<const bool> open{};      // per ray: no surface ends it, but the fog; empty = unknown

    vec3& part(size_t ray, size_t index) const { return parts[ray * (parts.size() / rays.size()) + index]; }
    size_t index_of(OtherLight light) const {
        return parts.size() / rays.size() - other_lights + static_cast<size_t>(light);
    }
};
using ScatterFunction = std::function<void(const RayBatch&, std::span<Scatter>)>;
}
