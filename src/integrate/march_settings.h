// How fog is marched through, and which terms of its light count.
#pragma once
#include "trace/transmittance/light_transmittance.h"

namespace tyndall {
struct Snapshot;
struct StyleSettings;

enum class Visibility { off, rays, maps, slices, exact };

struct MarchSettings {
    float step_depth = 0.25f;        // most optical depth per step
    float step_voxels = 8;           // most voxels per step
    float step_length = 1e6f;        // longest step, metres
    float step_share = 1.0f / 28;    // longest step as a share of the ray's stretch through fog
    float near_light = 0.5f;         // a step is at most this share of the distance to a local light
    int max_steps = 1024;            // per ray
    float min_transmittance = 1e-3f; // the march stops where less than this passes
    Visibility visibility = Visibility::slices;
    LightTransmittance light = LightTransmittance::grid;
    int light_resolution = 64; // cells across the fog in the light grids
    int light_points = 1;      // of a soft light, asked for shadows at once
    int nodes = 4;             // Gauss–Legendre nodes on each lit stretch of fog in closed form
    bool phase = true;         // off: isotropic
    bool heterogeneity = true; // off: bricks at their mean density
    bool emission = true;
    bool ambient = true;
};

// The snapshot as the terms of a march and the artist's controls leave it: terms that are off are taken out.
Snapshot march_snapshot(const Snapshot& snapshot, const MarchSettings& settings, const StyleSettings& style);
}
