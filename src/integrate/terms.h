// Terms of the light in fog that all techniques share, each with a switch or a choice of method.
#pragma once
#include "base/math.h"
#include "trace/transmittance/light_transmittance.h"

namespace tyndall {
struct Snapshot;

struct TermSettings {
    bool phase = true;         // off: isotropic
    bool heterogeneity = true; // off: grids at their mean density
    bool emission = true;
    bool ambient = true; // including the environment's light
    LightTransmittance light = LightTransmittance::grid;
    int light_resolution = 64; // cells across the fog in the light grids
    int light_points = 1;      // shadow sample points per soft light
};

// The snapshot without the terms that are switched off.
Snapshot with_terms(Snapshot snapshot, const TermSettings& terms);

// Ambient light in fog including the environment's mean, and a snapshot with it, for techniques without environments.
vec3 mean_ambient(const Snapshot& snapshot);
Snapshot with_mean_environment(Snapshot snapshot);

// For techniques without camera froxels: light grids replace them.
inline LightTransmittance without_froxels(LightTransmittance light) {
    return light == LightTransmittance::froxel ? LightTransmittance::grid : light;
}
}
