// Phase functions: how fog spreads the light it scatters. Each integrates to 1 over the sphere.
// cosine = dot(light travel, travel towards the eye): +1 looking straight into the light.
#pragma once
#include "base/math.h"

namespace tyndall {
enum class PhaseKind { isotropic, henyey_greenstein, schlick, rayleigh };

struct Phase {
    PhaseKind kind = PhaseKind::henyey_greenstein;
    float g = 0; // mean cosine, -1..1; above 0 scatters forward
};

inline constexpr float largest_g = 0.99f;        // beyond it the lobe is narrower than a pixel
inline constexpr float largest_schlick_g = 0.5f; // beyond it Schlick's form departs from the one it stands for

// Value in 1/sr.
inline float phase_value(Phase phase, float cosine) {
    switch (phase.kind) {
    case PhaseKind::isotropic:
        return 1 / (4 * pi);
    case PhaseKind::rayleigh:
        return 3 / (16 * pi) * (1 + cosine * cosine);
    case PhaseKind::henyey_greenstein: {
        // (1-|g|)² + 2|g|(1-c), c measured from the lobe, is 1+g²-2g·cosine without its cancellation in the lobe.
        const float g = std::min(std::abs(phase.g), largest_g), c = phase.g < 0 ? -cosine : cosine;
        const float q = std::max((1 - g) * (1 - g) + 2 * g * (1 - c), 1e-7f);
        return (1 - g * g) / (4 * pi * q * std::sqrt(q));
    }
    case PhaseKind::schlick: {
        const float k = 1.55f * phase.g - 0.55f * phase.g * phase.g * phase.g;
        const float q = 1 - k * cosine;
        return (1 - k * k) / (4 * pi * q * q);
    }
    }
    return 0;
}

// A direction picked with density phase_value(phase, dot(direction, result)), by two numbers in [0,1).
vec3 sample_phase(Phase phase, vec3 direction, vec2 u);
}
