// Constructs phase functions and samples directions by inverting their cumulative distributions.
#include "volume/phase.h"

#include "volume/phase/mie.h"

#include <cassert>

namespace tyndall {
namespace {
Phase shaped(PhaseKind kind, PhaseShape shape) {
    return {kind, 0, std::make_shared<const PhaseShape>(std::move(shape))};
}

// The lobes of a phase function.
std::vector<PhaseLobe> lobes_of(const Phase& phase) {
    if (phase.shape) return phase.shape->lobes;
    assert(phase.kind != PhaseKind::schlick);
    return {make_lobe(1, mean_cosine(phase), phase.kind == PhaseKind::rayleigh ? 1 : 0)};
}

void add_lobes(const Phase& phase, double share, std::vector<PhaseLobe>& lobes) {
    if (share > 0)
        for (const PhaseLobe& lobe : lobes_of(phase))
            lobes.push_back(make_lobe(share * lobe.weight, lobe.g, lobe.alpha));
}

// Inverse CDF: the cosine below which a fraction u of the scattered light lies.
double sampled_cosine(const Phase& phase, double u) {
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
    default:
        return sampled_cosine(*phase.shape, u);
    }
    return 2 * u - 1;
}
}

Phase draine_phase(double g, double alpha) { return shaped(PhaseKind::draine, shape_of({make_lobe(1, g, alpha)})); }

Phase mie_phase(double droplet_diameter) {
    const MieFit fit = mie_fit(droplet_diameter);
    return shaped(PhaseKind::mie, shape_of({make_lobe(1 - fit.draine_weight, fit.g, 0),
                                            make_lobe(fit.draine_weight, fit.draine_g, fit.draine_alpha)}));
}

Phase mixed_phase(double share, const Phase& first, const Phase& second) {
    std::vector<PhaseLobe> lobes;
    add_lobes(first, share, lobes), add_lobes(second, 1 - share, lobes);
    return shaped(PhaseKind::mix, shape_of(std::move(lobes)));
}

Phase table_phase(PhaseKind kind, PhaseTable table) { return shaped(kind, shape_of(std::move(table))); }

double min_phase_value(const Phase& phase) {
    if (phase.shape) return min_value(*phase.shape);
    double least = infinity;
    for (const double cosine : {-1.0, 0.0, 1.0}) least = std::min(least, phase_value_of<double>(phase, cosine));
    return least;
}

vec3 sample_phase(const Phase& phase, vec3 direction, vec2 u) {
    const double cosine = std::clamp(sampled_cosine(phase, u.x), -1.0, 1.0);
    const float sine = static_cast<float>(std::sqrt((1 - cosine) * (1 + cosine))), turn = 2 * pi * u.y;
    vec3 x, y;
    make_frame(direction, x, y);
    return glm::normalize(static_cast<float>(cosine) * direction + sine * std::cos(turn) * x +
                          sine * std::sin(turn) * y);
}
}
