// A camera moved by hand. Pure functions; angles in radians, the world's up is +Y, roll is kept.
#pragma once
#include "scene/camera.h"

namespace tyndall {
struct Scene;

// A camera and how far before it the point lies that it turns around.
struct Viewpoint {
    Camera camera;
    float distance = 5; // metres

    vec3 target() const { return camera.position + distance * camera.forward; }
};

// A camera of the scene with the point it looks at, or with the middle of the scene as far before it as that is.
Viewpoint viewpoint_of(const Scene& scene, int camera, double seconds);

// Around the target, as if the scene were turned: x to the right, y upwards. Never over the poles.
Viewpoint orbited(Viewpoint from, vec2 angle);

// The camera looks elsewhere from where it stands: x to the right, y upwards.
Viewpoint turned(Viewpoint from, vec2 angle);

// Aside, in picture heights at the target: the scene follows a hand that moves right and up.
Viewpoint panned(Viewpoint from, vec2 heights);

// Towards the target or away from it: its distance times a factor above 0.
Viewpoint dollied(Viewpoint from, float factor);

// Metres to the right, along the world's up and forward.
Viewpoint flown(Viewpoint from, vec3 metres);
}
