// A phase function as a scene file states it: by name with the medium's g, or as an object with its own parameters.
#pragma once
#include "scene/keyed.h"
#include "volume/phase.h"

#include <memory>
#include <vector>

namespace tyndall {
struct PhaseSource {
    PhaseKind kind = PhaseKind::henyey_greenstein;
    bool own_numbers = false;                // stated as an object; else g is the medium's
    Keyed<float> g{0.0f}, alpha{0.0f};       // Henyey-Greenstein, Draine
    Keyed<float> droplet_diameter{10.0f};    // mie: micrometers
    Keyed<float> weight{0.5f};               // mix: weight of the first lobe
    std::vector<PhaseSource> lobes;          // mix: two
    std::shared_ptr<const PhaseShape> shape; // table, legendre

    // Whether the medium's g is used.
    bool takes_medium_g() const { return !own_numbers && takes_g(kind); }
};

// The phase function at a time; `g` is the medium's at that time, used if takes_medium_g().
Phase phase_at(const PhaseSource& source, float g, double seconds);
}
