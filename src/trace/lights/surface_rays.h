// Light that surfaces receive along rays, shadowed and attenuated by fog.
#pragma once
#include "trace/occlusion/occluders.h"

#include <span>

namespace tyndall {
struct Medium;

// A ray from each of up to 16 surface points, and the light that arrives along it if nothing is in the way.
struct SurfaceRays {
    Occluders::ShadowRays rays{};
    vec3 light[16] = {};

    // Sets no ray if the light is 0.
    void set(size_t i, const SurfacePoint& point, vec3 direction, float length, vec3 arriving) {
        if (!(max_component(arriving) > 0)) return;
        light[i] = arriving;
        rays.set(i, off_surface(point.face_normal, {point.position, direction, length}));
    }
};

// Adds `scale` times the light of each ray, as far as `casters` (may be null) and the media let it through.
void add_unblocked(const SurfaceRays& to, const Occluders* casters, std::span<const Medium> media,
                   std::span<const SurfacePoint> points, float scale, std::span<vec3> sum);
}
