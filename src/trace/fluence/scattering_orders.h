// Ratio of multiple to single scattering in fog: whether single scattering suffices.
#pragma once
#include <cstdint>

namespace tyndall {
struct Medium;
struct Snapshot;

// Power that fog scatters of light that was scattered before, over that of light straight from the lights.
struct ScatteringRatio {
    double ratio = 0, low = 0, high = 0; // low..high: 95 % confidence
};

// For a homogeneous sphere in a broad beam, by its optical radius (extinction times radius): w P/(1 - w P), where P is
// the probability that light scattered in the sphere collides again, with scattering points as uniform as under
// isotropic illumination. Does not depend on the phase function (Blanco & Fournier 2003).
double multiple_over_single(double optical_radius, double albedo);

// For a single medium in a broad beam, taken as a homogeneous sphere of the same volume: within 12 % for cubes, too
// high for flat boxes. Infinite for unbounded fog without absorption.
double multiple_over_single(const Medium& medium);

// Measured in a scene by tracing light paths, surfaces included. 0 without lights; if no path meets the fog, `high` is
// what truncation_bound() allows.
ScatteringRatio measured_ratio(const Snapshot& snapshot, int paths = 8192, uint32_t seed = 0);

// Bound on the light missing without orders above N = `orders`, relative to the largest source of order 1: q^N/(1 - q)
// with q = albedo (1 - e^-τ), τ no less than the optical depth of any line through the fog. Ignores surfaces.
double truncation_bound(const Snapshot& snapshot, int orders);
}
