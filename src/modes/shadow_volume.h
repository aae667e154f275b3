// Fog between shadow volumes: what is made once per frame, and the integral along a packet of rays.
#pragma once
#include "modes/gauss_legendre.h"
#include "modes/light_along.h"
#include "modes/mode.h"
#include "trace/kept_shadows.h"
#include "trace/light_depth.h"

namespace tyndall {
// A light that casts shadows, and its volumes from the camera.
struct ShadowCaster {
    std::shared_ptr<const ShadowVolumes> volumes;
    std::shared_ptr<const ShadowView> view;
};

struct ShadowVolumeFrame {
    Snapshot snapshot; // media and lights as the settings see them
    ShadowVolumeSettings settings;
    StyleSettings style;
    Camera camera;
    float margin = 0;        // pixels a ray may stray from its pixel
    bool sampled = false;    // fog is
    std::vector<Box> uneven; // fog that is not what it is taken for
    std::vector<LightDepth> depths;
    std::vector<ConeFalloff> cones;
    std::vector<ShadowCaster> casters; // one per light; empty where it casts no shadows
};

// Where rays are cut: between cuts the fog is smooth, or a step long.
struct FogCuts {
    std::vector<float> at; // [cut·16 + ray], ascending; the last repeated where other rays have more
    int pieces[16];        // between the cuts of each ray; 0 without fog
    int most = 0;          // of any ray

    float low(size_t ray) const { return at[ray]; }
    float high(size_t ray) const { return at[16 * static_cast<size_t>(pieces[ray]) + ray]; }
};
void find_cuts(const ShadowVolumeFrame& frame, std::span<const Ray> rays, FogCuts& cuts);

// Fog along up to 16 rays.
void shadow_volume_packet(const ShadowVolumeFrame& frame, const RayBatch& batch, std::span<Scatter> results);

// What rays cross of the volumes of a light, up to the ends of `reached`; `dark` = the counts before. Rays whose
// stretch is empty are left out.
void find_shadows(const ShadowVolumeFrame& frame, size_t light, const RayBatch& batch, const Stretch (&reached)[16],
                  std::vector<ShadowCrossing>& crossings, int (&dark)[16]);
}
