// A thin lens: its camera rays and its defocus blur.
#pragma once
#include "base/math.h"

namespace tyndall {
struct Camera;

struct Lens {
    float radius = 0;       // of the aperture, meters; 0 = a pinhole
    float focus = infinity; // distance to the plane of focus along the viewing direction, meters
    int blades = 0;         // 3 or more: the aperture is a regular polygon inscribed in its circle; fewer: it is round
    float rotation = 0; // radians from the right to the first corner, counterclockwise as seen from behind the camera

    explicit operator bool() const { return radius > 0; }
};

// Fields in the order of cache files.
template<class Visit> void fields(Lens& lens, Visit& visit) {
    visit(lens.radius), visit(lens.focus), visit(lens.blades), visit(lens.rotation);
}

// Samples a point of the aperture uniformly by area from u in [0,1)²: meters to the right and up.
vec2 aperture_point(const Lens& lens, vec2 u);

// The ray from a point of the aperture through the point where the pinhole's ray, camera_ray(), meets the plane of
// focus. For perspective cameras.
Ray lens_ray(const Camera& camera, ivec2 size, vec2 pixel, vec2 on_aperture);

// Diameter of the circle of confusion of a point at a planar depth, pixels (thin lens): the aperture as seen from the
// point, projected onto the plane of focus.
float blur_diameter(const Camera& camera, ivec2 size, float depth);

// Largest distance between rays through the lens and their pinhole's ray at a planar depth, meters.
float lens_reach(const Lens& lens, float depth);
}
