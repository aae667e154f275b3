// How fog spreads light, as a scene file says it: by a name, its g beside it, or by an object of its own.
#pragma once
#include "scene/keyed.h"
#include "volume/phase.h"

#include <memory>
#include <vector>

namespace tyndall {
struct PhaseSource {
    PhaseKind kind = PhaseKind::henyey_greenstein;
    bool own_numbers = false;                // an object; else g is that of the medium
    Keyed<float> g{0.0f}, alpha{0.0f};       // Henyey-Greenstein, Draine
    Keyed<float> droplet_diameter{10.0f};    // mie: micrometres
    Keyed<float> weight{0.5f};               // mix: share of the first
    std::vector<PhaseSource> lobes;          // mix: two
    std::shared_ptr<const PhaseShape> shape; // table, legendre

    // Whether the medium's g counts.
    bool takes_medium_g() const { return !own_numbers && takes_g(kind); }
};

// With the medium's g at that moment, which counts where takes_medium_g().
Phase phase_at(const PhaseSource& source, float g, double seconds);
}
