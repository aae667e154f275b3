// The points whose motion across the image tells how fast things move while the shutter is open.
#pragma once
#include "base/math.h"
#include "trace/shutter_shadows.h"

#include <vector>

namespace tyndall {
struct Camera;
struct Scene;

// What is the same at all times of an exposure.
struct ShutterPoints {
    const Scene& scene;
    float extent = 10;              // of the scene, meters
    std::vector<vec3> forward;      // of each light, in the middle of the exposure
    std::vector<Box> meshes, media; // in their own space; empty where bounds are unknown
    std::vector<vec2> columns;      // x and z of places in view, for fog that depends on height
    std::vector<ShadowRay> shadows;
};

// `camera`: in the middle of the exposure, at `seconds`. Reads the headers of volume files.
ShutterPoints shutter_points(const Scene& scene, const Camera& camera, ivec2 size, int frame, double seconds);

// Positions at a time: of lights, what their beams and shadows reach, surfaces, and fog; always in the same order. Not
// finite where there is nothing to see at that time.
std::vector<vec3> points_at(const ShutterPoints& points, double seconds);
}
