// A thin lens in front of a camera: which rays it takes, and how it blurs what is out of focus.
#pragma once
#include "base/math.h"

namespace tyndall {
struct Camera;

struct Lens {
    float radius = 0;       // of the aperture, metres; 0 = a pinhole
    float focus = infinity; // what is sharp: the distance along the viewing direction, metres
    int blades = 0;         // of the aperture, whose corners lie on its circle: 3 or more; below, it is round
    float turn = 0;         // radians, of the first corner from the right, counterclockwise from behind the camera

    explicit operator bool() const { return radius > 0; }
};

// Of cache files, in this order.
template<class Visit> void fields(Lens& lens, Visit& visit) {
    visit(lens.radius), visit(lens.focus), visit(lens.blades), visit(lens.turn);
}

// A point of the aperture from numbers in [0,1), evenly over its area: to the right and up, metres.
vec2 aperture_point(const Lens& lens, vec2 u);

// The ray from a point of the aperture through where the pinhole's ray, camera_ray(), meets the plane in focus.
// Of a perspective camera.
Ray lens_ray(const Camera& camera, ivec2 size, vec2 pixel, vec2 on_aperture);

// Diameter of the disc that a point at a planar depth becomes in the picture, pixels (thin lens): the aperture seen
// from there, on the plane in focus.
float blur_diameter(const Camera& camera, ivec2 size, float depth);

// How far rays through the lens stray from their pinhole's rays at a planar depth, metres at most.
float lens_reach(const Lens& lens, float depth);
}
