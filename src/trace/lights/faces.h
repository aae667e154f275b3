// Area lights: how the camera sees them, and their light on surfaces.
#pragma once
#include "base/math.h"

#include <span>

namespace tyndall {
struct Light;
struct Snapshot;
struct SurfacePoint;

// Whether any light's face is visible to the camera; and the nearest one that a ray hits, -1 = none.
bool shows_faces(const Snapshot& snapshot);
struct FaceHit {
    int light = -1;
    float distance = infinity; // meters
};
FaceHit visible_face(const Snapshot& snapshot, const Ray& ray);

// Adds the irradiance of an area light at up to 16 Lambertian surfaces, cosine and surface_scale included, shadowed
// and, with `dimmed`, attenuated by fog. `u`: points × n sample pairs, which choose n points of the face for each.
void add_face_light(const Snapshot& snapshot, const Light& light, bool dimmed, std::span<const SurfacePoint> points,
                    std::span<const vec2> u, std::span<vec3> irradiance);
}
