// Lights that are faces: what the camera sees of them, and what they bring to surfaces.
#pragma once
#include "base/math.h"

#include <span>

namespace tyndall {
struct Light;
struct Snapshot;
struct SurfacePoint;

// Whether the camera may see the face of any light; and the nearest one that a ray meets, -1 = none.
bool shows_faces(const Snapshot& snapshot);
struct FaceHit {
    int light = -1;
    float distance = infinity; // metres
};
FaceHit visible_face(const Snapshot& snapshot, const Ray& ray);

// Adds the irradiance of a light with a face to up to 16 Lambert surfaces, cosine and surface_scale included, past
// surfaces and, with `dimmed`, through the fog. `u`: points × n pairs of numbers, that pick n points of the face each.
void add_face_light(const Snapshot& snapshot, const Light& light, bool dimmed, std::span<const SurfacePoint> points,
                    std::span<const vec2> u, std::span<vec3> irradiance);
}
