// The interface of a technique: fog along up to 16 neighboring camera rays.
#pragma once
#include "base/math.h"
#include "trace/sampling/sample_place.h"

#include <cstdint>
#include <functional>
#include <span>

namespace tyndall {
// The effect of fog on one camera ray up to its t_max.
struct Scatter {
    vec3 radiance{0};        // light scattered and emitted toward the eye
    float transmittance = 1; // mean over the channels
    float validity = 1;      // 0 where the mode knows its result is wrong
    int steps = 0;           // number of evaluations, for statistics
    // Modes with Surfaces::own: light of surfaces and of the background, attenuated by the fog.
    vec3 surface{0}, background{0};
    float holdout = 0; // such modes: share of the light from behind the fog that holdout mattes block
    vec3 tint{1};      // per-channel transmittance relative to its mean

    vec3 whole() const { return surface + background + radiance; }
};

// Light in fog that does not come from a single light of the scene: ambient light, emission, and multiple scattering
// that cannot be attributed to a light.
enum class OtherLight : size_t { ambient, emission, multiple };
inline constexpr size_t other_lights = 3;

// The number of parts of a ray's light in fog: one per light, then one per kind of other light.
constexpr size_t part_count(size_t lights) { return lights + other_lights; }

// Up to 16 neighboring rays (4×4 pixels) of one pixel sample.
struct RayBatch {
    std::span<const Ray> rays{};
    std::span<const uint32_t> ids{}; // per ray, unique to pixel and sample: seed for random numbers
    std::span<vec3> parts{};         // empty, or rays × part_count(lights) radiances that the mode adds to
    std::span<const float> jitter{}; // per ray, in [0,1), stratified over the samples of a pixel; empty = ½
    std::span<const SampleIndex> sample_indices{}; // per ray, in its pixel's low-discrepancy sequence; empty = use ids
    std::span<const float> clip_near{}; // Surfaces::own, per ray: nearer surfaces are ignored, fog is not; empty = 0
    std::span<const vec2> positions{};  // of the rays in the image, in pixels from the upper left; empty = unknown
    std::span<const bool> open{};       // per ray: does not hit a surface; empty = unknown

    vec3& part(size_t ray, size_t index) const { return parts[ray * (parts.size() / rays.size()) + index]; }
    size_t index_of(OtherLight light) const {
        return parts.size() / rays.size() - other_lights + static_cast<size_t>(light);
    }
};
using ScatterFunction = std::function<void(const RayBatch&, std::span<Scatter>)>;
}
