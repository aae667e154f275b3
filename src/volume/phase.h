// Phase functions: how fog spreads the light it scatters. Each integrates to 1 over the sphere.
// cosine = dot(light travel, travel towards the eye): +1 looking straight into the light.
#pragma once
#include "base/math.h"

#include <numbers>
#include <string_view>

namespace tyndall {
enum class PhaseKind { isotropic, henyey_greenstein, schlick, rayleigh };

struct Phase {
    PhaseKind kind = PhaseKind::henyey_greenstein;
    float g = 0; // mean cosine, -1..1; above 0 scatters forward
};

inline constexpr float largest_g = 0.99f; // beyond it the lobe is narrower than a pixel

struct PhaseTraits {
    std::string_view name;     // in scene files
    float max_g = 0;           // 0 = takes no g
    std::string_view beyond{}; // what is wrong with a larger one, and what to use
};
inline constexpr PhaseTraits phase_kinds[] = {
    {.name = "isotropic"},
    {.name = "henyey_greenstein", .max_g = 1, .beyond = "g lies between -1 and 1"},
    {.name = "schlick",
     .max_g = 0.5f,
     .beyond = "Schlick's form departs from Henyey-Greenstein's beyond |g| = 0.5; use \"henyey_greenstein\""},
    {.name = "rayleigh"},
};
constexpr const PhaseTraits& traits_of(PhaseKind kind) { return phase_kinds[static_cast<int>(kind)]; }
constexpr bool takes_g(PhaseKind kind) { return traits_of(kind).max_g > 0; }

inline float mean_cosine(Phase phase) { return takes_g(phase.kind) ? std::clamp(phase.g, -largest_g, largest_g) : 0; }

// Value in 1/sr, to the rounding of T.
template<class T> T phase_value_of(Phase phase, T cosine) {
    constexpr T circle = std::numbers::pi_v<T>;
    const T mean = phase.g;
    switch (phase.kind) {
    case PhaseKind::isotropic:
        return 1 / (4 * circle);
    case PhaseKind::rayleigh:
        return 3 / (16 * circle) * (1 + cosine * cosine);
    case PhaseKind::henyey_greenstein: {
        // (1-|g|)² + 2|g|(1-c), c measured from the lobe, is 1+g²-2g·cosine without its cancellation in the lobe.
        const T g = std::min<T>(std::abs(mean), largest_g), c = mean < 0 ? -cosine : cosine;
        const T q = std::max<T>((1 - g) * (1 - g) + 2 * g * (1 - c), 1e-7f);
        return (1 - g * g) / (4 * circle * q * std::sqrt(q));
    }
    case PhaseKind::schlick: {
        const T k = T(1.55f) * mean - T(0.55f) * mean * mean * mean;
        const T q = 1 - k * cosine;
        return (1 - k * k) / (4 * circle * q * q);
    }
    }
    return 0;
}

inline float phase_value(Phase phase, float cosine) { return phase_value_of<float>(phase, cosine); }

// A direction picked with density phase_value(phase, dot(direction, result)), by two numbers in [0,1).
vec3 sample_phase(Phase phase, vec3 direction, vec2 u);
}
