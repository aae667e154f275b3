// The march with shadow maps of one packet, apart from its preparation.
#pragma once
#include "integrate/ray_batch.h"
#include "modes/settings.h"
#include "modes/shadow_map/settings.h"
#include "trace/shadows/cached_shadows.h"
#include "trace/snapshot.h"
#include "trace/transmittance/light_depth.h"

#include <vector>

namespace tyndall {
inline constexpr int map_lookups = 4; // of each step, in the shadow maps: narrow shafts need more than fog does

// What the march needs, made once per frame.
struct ShadowMapMarch {
    Snapshot snapshot; // media and lights as the settings see them
    ShadowMapSettings settings;
    StyleSettings style;
    Camera camera;                  // for style.range
    std::vector<LightDepth> depths; // one per light
    std::vector<ConeFalloff> cones; // one per light
    ShadowMaps maps;                // one per light
    float detail = infinity;        // metres: the finest detail of the fog
    bool colored = false;           // a light has a coloured gobo
    bool narrow_lobe = false;       // of the fog: steps in the light of lamps crowd where light goes straight on
};

// Smallest detail of the brick media, metres: that of a noise's last octave is some voxels wide.
float fog_detail(std::span<const Medium> media);

inline constexpr int min_uneven_steps = 8; // fewer are even

// The borders of `count` steps along a ray from first to last fog, t[0], t[stride], ...; the last is t[count·stride].
// Of fog that goes on far beyond the scene the scene gets most steps, and what follows ever longer ones. All equal when
// there is no fog.
void place_steps(const ShadowMapMarch& march, const Ray& ray, int count, float* t, size_t stride);

// Fog along up to 16 rays, in steps of homogeneous fog whose integral is exact: L += T J (1-e^-D)/σ, T *= e^-D
// (Hillaire 2015, section 5.6.3). Suns are asked for at the steps of the ray; a local light has as many steps of its
// own on what it reaches, where 1/r² is integrated exactly (Kulla & Fajardo 2012, section 4.1).
void march_shadow_maps(const ShadowMapMarch& march, const RayBatch& batch, std::span<Scatter> results);
}
