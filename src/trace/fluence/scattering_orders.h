// How much light fog scatters more than once, as a share of what it scatters once: whether single scattering will do.
#pragma once
#include <cstdint>

namespace tyndall {
struct Medium;
struct Snapshot;

// The power that fog scatters of light that has been scattered before, over that of light straight from the lights.
struct ScatteringRatio {
    double ratio = 0, low = 0, high = 0; // low..high: 95 % confidence
};

// Of an even ball in a broad beam, by its extinction times its radius: w P/(1 - w P), where P is the chance that light
// scattered in the ball meets it again, when it is spread as evenly in the ball as in even light from all around. The
// phase function does not count (Blanco & Fournier 2003).
double multiple_over_single(double optical_radius, double albedo);

// Of a medium alone in a broad beam, as an even ball of the same volume: within 12 % for cubes, too much
// where it is flat. Infinite when it has no bounds and takes nothing.
double multiple_over_single(const Medium& medium);

// Measured in a scene by light paths; surfaces count. 0 when no light reaches the fog.
ScatteringRatio measured_ratio(const Snapshot& snapshot, int paths = 8192, uint32_t seed = 0);

// At most so much of the largest source of order 1 is missing where orders above `orders` are left out, q^N/(1 - q)
// with q = albedo (1 - e^-τ), and τ no less than the optical depth of any line through the fog. Excludes surfaces.
double truncation_bound(const Snapshot& snapshot, int orders);
}
