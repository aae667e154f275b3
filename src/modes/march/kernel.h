// The march of one packet, apart from its preparation.
#pragma once
#include "integrate/march_steps.h"
#include "integrate/ray_batch.h"
#include "integrate/style.h"
#include "trace/fluence/fluence.h"
#include "trace/shadows/cached_shadows.h"
#include "trace/shadows/intervals/shadow_slices.h"
#include "trace/snapshot.h"
#include "trace/transmittance/light_depth.h"

#include <vector>

namespace tyndall {
// What a march needs, made once per frame.
struct March {
    Snapshot snapshot; // media as the settings see them
    MarchSettings settings;
    int light_points = 1; // of a soft light
    StyleSettings style;
    Camera camera;                  // for style.range
    std::vector<LightDepth> depths; // one per light
    std::vector<ConeFalloff> cones; // one per light
    MarchSteps steps;
    ShadowSlices slices;                        // with Visibility::exact
    ShadowMaps maps;                            // with Visibility::maps, one per light
    std::shared_ptr<const FluenceGrid> fluence; // null = light scatters once only
};

// Fog along up to 16 rays. Source function and extinction are sampled once per step; within a step they are constant
// and the integral is exact: L += T J (1-e^-D)/σ, T *= e^-D (Hillaire 2015, section 5.6.3).
void march_packet(const March& march, const RayBatch& batch, std::span<Scatter> results);
}
