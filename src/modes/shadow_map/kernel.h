// Ray marching with shadow maps for one packet of rays, separate from its preparation.
#pragma once
#include "integrate/ray_batch.h"
#include "modes/settings.h"
#include "modes/shadow_map/settings.h"
#include "trace/shadows/cached_shadows.h"
#include "trace/snapshot.h"
#include "trace/transmittance/light_depth.h"

#include <vector>

namespace tyndall {
inline constexpr int map_lookups = 4; // shadow-map look-ups per step: narrow shafts need more samples than fog does

// Data for the march, made once per frame.
struct ShadowMapMarch {
    Snapshot snapshot; // media and lights with the settings applied
    ShadowMapSettings settings;
    StyleSettings style;
    Camera camera;                  // for style.range
    std::vector<LightDepth> depths; // one per light
    std::vector<ConeFalloff> cones; // one per light
    ShadowMaps maps;                // one per light
    float detail = infinity;        // meters: the finest detail of the fog
    bool colored = false;           // a light has a colored gobo
    bool narrow_lobe = false;       // the fog's phase function has a narrow lobe
};

inline constexpr int min_uneven_steps = 8; // fewer steps are equal

// Boundaries of `count` steps along a ray from its first to its last fog: t[0], t[stride], ..., t[count·stride]. If the
// fog extends far beyond the scene, most steps are inside the scene, and those behind it grow in length. All are equal
// if the ray has no fog.
void place_steps(const ShadowMapMarch& march, const Ray& ray, int count, float* t, size_t stride);

// Fog along up to 16 rays, in steps of homogeneous fog integrated exactly: L += T J (1-e^-D)/σ, T *= e^-D (Hillaire
// 2015, section 5.6.3). Suns are evaluated at the steps of the ray; a local light has the same number of its own steps
// on the segment it reaches, where 1/r² is integrated exactly (Kulla & Fajardo 2012, section 4.1).
void march_shadow_maps(const ShadowMapMarch& march, const RayBatch& batch, std::span<Scatter> results);
}
