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
    float extent = 10;                    // of the scene, meters
    std::vector<vec3> forward;            // of each light, in the middle of the exposure
    std::vector<Box> meshes, media;       // in their own space; empty where bounds are unknown
    std::vector<vec3> view;               // places in view
    std::vector<std::vector<vec3>> noise; // of each medium: places in noise that drifts, in the medium's own space
    std::vector<ShadowRay> shadows;
    double middle = 0; // seconds: when noise is at its places
};

// `camera`: in the middle of the exposure, at `seconds`. Reads the headers of volume files.
ShutterPoints shutter_points(const Scene& scene, const Camera& camera, ivec2 size, int frame, double seconds);

// Positions at a time: of lights, what their beams and shadows reach, surfaces, fog, and places in view; always in the
// same order. Not finite where there is nothing to see at that time.
std::vector<vec3> points_at(const ShutterPoints& points, double seconds);
}
