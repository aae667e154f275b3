// Fog between shadow volumes: what is made once per frame, and the integral along a packet of rays.
#pragma once
#include "modes/gauss_legendre.h"
#include "modes/light_along.h"
#include "modes/mode.h"
#include "trace/light_depth.h"
#include "trace/shadow_view.h"

namespace tyndall {
// A light that casts shadows, and its volumes from the camera.
struct ShadowCaster {
    ShadowVolumes volumes;
    ShadowView view;
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
    std::vector<ShadowCaster> casters; // one per light; without mesh where it casts no shadows
    std::vector<QuadratureNode> nodes; // on -1..1
};

// Where a ray is cut: between cuts the fog is smooth, or a step long.
struct FogCuts {
    std::vector<double> at; // ascending; empty without fog
};
void find_cuts(const ShadowVolumeFrame& frame, const Ray& ray, FogCuts& cuts);

// Fog along up to 16 rays.
void shadow_volume_packet(const ShadowVolumeFrame& frame, const RayBatch& batch, std::span<Scatter> results);

// What each ray crosses of the volumes of a light, up to the ends of `reached`, by the ray's own t; `dark` = the count
// before. Rays whose stretch is empty are left out.
void find_shadows(const ShadowVolumeFrame& frame, size_t light, const RayBatch& batch, const Stretch (&reached)[16],
                  std::vector<ShadowCrossing> (&crossings)[16], int (&dark)[16]);
}
