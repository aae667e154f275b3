// Interactive camera motion. Pure functions; angles in radians, the world's up is +Y, roll is kept.
#pragma once
#include "scene/camera.h"

namespace tyndall {
struct Scene;

// A camera and the distance to the point it orbits.
struct Viewpoint {
    Camera camera;
    float distance = 5; // meters

    vec3 target() const { return camera.position + distance * camera.forward; }
};

// A camera of the scene that orbits the point it looks at, or for cameras of the glTF, a point as far ahead as the
// scene's center.
Viewpoint viewpoint_of(const Scene& scene, int camera, double seconds);

// Orbits the target, as if the scene were turned: x to the right, y upwards. Never over the poles.
Viewpoint orbited(Viewpoint from, vec2 angle);

// Turns the camera in place: x to the right, y upwards.
Viewpoint turned(Viewpoint from, vec2 angle);

// Pans by image heights at the target: the scene follows a pointer that moves right and up.
Viewpoint panned(Viewpoint from, vec2 heights);

// Moves towards the target or away from it: multiplies its distance by a factor above 0.
Viewpoint dollied(Viewpoint from, float factor);

// Moves by meters to the right, along the world's up, and forward.
Viewpoint flown(Viewpoint from, vec3 meters);
}
