// Terms of the light in fog that all techniques share, each a switch or a choice of how it is found.
#pragma once
#include "base/math.h"
#include "trace/transmittance/light_transmittance.h"

namespace tyndall {
struct Snapshot;

struct TermSettings {
    bool phase = true;         // off: isotropic
    bool heterogeneity = true; // off: bricks at their mean density
    bool emission = true;
    bool ambient = true; // with the environment's light
    LightTransmittance light = LightTransmittance::grid;
    int light_resolution = 64; // cells across the fog in the light grids
    int light_points = 1;      // of a soft light, asked for shadows at once
};

// The snapshot without the terms of fog that are off.
Snapshot with_terms(Snapshot snapshot, const TermSettings& terms);

// Ambient light in fog, the environment's mean included; and a snapshot with that, for what knows no environment.
vec3 mean_ambient(const Snapshot& snapshot);
Snapshot with_mean_environment(Snapshot snapshot);

// How light that nothing looks up before the camera is dimmed: grids before the lights instead.
inline LightTransmittance without_froxels(LightTransmittance light) {
    return light == LightTransmittance::froxel ? LightTransmittance::grid : light;
}
}
