// Directions distributed as the phase functions, by inverting their cumulative distributions.
#include "volume/phase.h"

namespace tyndall {
namespace {
// Cosine below which the share u of the scattered light lies.
double sampled_cosine(Phase phase, double u) {
    switch (phase.kind) {
    case PhaseKind::isotropic:
        break;
    case PhaseKind::rayleigh: {
        // c³ + 3c = 8u - 4, by Cardano's formula (Frisvad 2011).
        const double half = 4 * u - 2, root = std::cbrt(std::abs(half) + std::sqrt(half * half + 1));
        return std::copysign(root - 1 / root, half);
    }
    case PhaseKind::henyey_greenstein: {
        const double g = std::clamp(phase.g, -largest_g, largest_g);
        if (std::abs(g) < 1e-3) break;
        const double s = (1 - g * g) / (1 - g + 2 * g * u);
        return (1 + g * g - s * s) / (2 * g);
    }
    case PhaseKind::schlick: {
        const double k = 1.55 * phase.g - 0.55 * phase.g * phase.g * phase.g;
        return (2 * u + k - 1) / (2 * k * u - k + 1);
    }
    }
    return 2 * u - 1;
}
}

vec3 sample_phase(Phase phase, vec3 direction, vec2 u) {
    const double cosine = std::clamp(sampled_cosine(phase, u.x), -1.0, 1.0);
    const float sine = static_cast<float>(std::sqrt((1 - cosine) * (1 + cosine))), turn = 2 * pi * u.y;
    vec3 x, y;
    make_frame(direction, x, y);
    return glm::normalize(static_cast<float>(cosine) * direction + sine * std::cos(turn) * x +
                          sine * std::sin(turn) * y);
}
}
