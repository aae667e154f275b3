// Phase functions, normalized to integrate to 1 over the sphere.
// cosine = dot(light direction of travel before and after scattering): +1 is forward, looking into the light.
#pragma once
#include "base/math.h"
#include "volume/phase/shape.h"

#include <memory>
#include <numbers>
#include <span>
#include <string_view>

namespace tyndall {
enum class PhaseKind { isotropic, henyey_greenstein, schlick, rayleigh, draine, mie, mix, table, legendre };

struct Phase {
    PhaseKind kind = PhaseKind::henyey_greenstein;
    float g = 0;                               // mean cosine, -1..1; above 0 scatters forward
    std::shared_ptr<const PhaseShape> shape{}; // for draine and later kinds, which do not use g
};

inline constexpr float largest_g = 0.99f; // beyond it the lobe is narrower than a pixel

struct PhaseTraits {
    std::string_view name;      // as in scene files
    float max_g = 0;            // 0 = takes no g
    std::string_view g_error{}; // error for a larger |g|, and what to use instead
};
inline constexpr PhaseTraits phase_kinds[] = {
    {.name = "isotropic"},
    {.name = "henyey_greenstein", .max_g = 1, .g_error = "g must be between -1 and 1"},
    {.name = "schlick",
     .max_g = 0.5f,
     .g_error = "Schlick's approximation departs from Henyey-Greenstein beyond |g| = 0.5; use \"henyey_greenstein\""},
    {.name = "rayleigh"},
    {.name = "draine"},
    {.name = "mie"},
    {.name = "mix"},
    {.name = "table"},
    {.name = "legendre"},
};
constexpr const PhaseTraits& traits_of(PhaseKind kind) { return phase_kinds[static_cast<int>(kind)]; }
constexpr bool takes_g(PhaseKind kind) { return traits_of(kind).max_g > 0; }

// Droplet diameters are in micrometers, above 0 and up to largest_droplet (volume/phase/mie.h). A mix has a share 0..1
// of the first and the rest of the second, neither of which may be Schlick's or a table. Tables keep their kind.
Phase draine_phase(double g, double alpha);
Phase mie_phase(double droplet_diameter);
Phase mixed_phase(double share, const Phase& first, const Phase& second);
Phase table_phase(PhaseKind kind, PhaseTable table);

// The phase function averaged over discs of an angular radius below 0.15 radians, as a table; draine and later kinds.
Phase widened(const Phase& phase, double radius);

inline float mean_cosine(const Phase& phase) {
    if (phase.shape) return phase.shape->mean_cosine;
    return takes_g(phase.kind) ? std::clamp(phase.g, -largest_g, largest_g) : 0;
}

// |g| of the narrowest lobe, which determines the required angular resolution.
inline float narrowest_g(const Phase& phase) {
    return phase.shape ? phase.shape->narrowest : std::abs(mean_cosine(phase));
}

// A lower bound of the phase function, 1/sr, tight up to rounding; 0 if values may be 0.
double min_phase_value(const Phase& phase);

// Value in 1/sr, in the precision of T.
template<class T> T phase_value_of(const Phase& phase, T cosine) {
    constexpr T circle = std::numbers::pi_v<T>;
    const T mean = phase.g;
    switch (phase.kind) {
    case PhaseKind::isotropic:
        return 1 / (4 * circle);
    case PhaseKind::rayleigh:
        return 3 / (16 * circle) * (1 + cosine * cosine);
    case PhaseKind::henyey_greenstein: {
        // (1-|g|)² + 2|g|(1-c), c measured from the lobe axis, equals 1+g²-2g·cosine without cancellation near the
        // axis.
        const T g = std::min<T>(std::abs(mean), largest_g), c = mean < 0 ? -cosine : cosine;
        const T q = std::max<T>((1 - g) * (1 - g) + 2 * g * (1 - c), 1e-7f);
        return (1 - g * g) / (4 * circle * q * std::sqrt(q));
    }
    case PhaseKind::schlick: {
        const T k = T(1.55f) * mean - T(0.55f) * mean * mean * mean;
        const T q = 1 - k * cosine;
        return (1 - k * k) / (4 * circle * q * q);
    }
    default:
        return shape_value<T>(*phase.shape, cosine);
    }
}

inline float phase_value(const Phase& phase, float cosine) { return phase_value_of<float>(phase, cosine); }

// The larger of the values in the forward and backward directions, 1/sr.
inline float phase_peak(const Phase& phase) { return std::max(phase_value(phase, 1.0f), phase_value(phase, -1.0f)); }

// Samples a direction with PDF phase_value(phase, dot(direction, result)) from two numbers in [0,1).
vec3 sample_phase(const Phase& phase, vec3 direction, vec2 u);
}
