// Faces that glow with the same radiance in every direction, and everywhere but where a rectangle has a picture:
// rectangles, discs and balls.
#pragma once
#include "scene/light.h"

namespace tyndall {
struct Gobo;

struct AreaShape {
    LightKind kind = LightKind::rectangle;
    vec3 center{0};
    vec3 normal{0, -1, 0}, right{1, 0, 0}, up{0, 0, -1}; // unit; normal: the way the light goes
    vec2 half{0.5f};        // metres along right and up; disc and sphere: the radius, twice
    bool two_sided = false; // rectangle, disc
    bool visible = true;    // to the camera, from the side that glows
    // Rectangle: what of its radiance glows where, as a screen shows it to who looks at it; null = all alike.
    std::shared_ptr<const Gobo> picture;
    vec3 picture_scale{1}; // makes the picture's mean 1; set by stand_for()
    float spread = 1;      // mean square of how far the light is from its middle, over that of an even face; likewise
};

// Square metres of the face as seen along its axis.
float face_area(const AreaShape& shape);

// Makes the light, whose place, intensity (candela along the axis) and scales are known, a lamp that stands for the
// shape: in the middle of its light, as large as its face, with Lambert's cosine and the mean of the picture. Without a
// face it is dark.
void stand_for(const AreaShape& shape, Light& light);

// Nits of a light with a shape; mean over its face.
vec3 radiance_of(const Light& light);

// What the picture makes of that at a place of the face: 1 without one.
vec3 face_picture(const AreaShape& shape, vec3 at);

// A direction towards a point of the face, picked by two numbers in [0,1).
struct AreaSample {
    vec3 direction{0, 1, 0};
    float distance = 0;   // metres
    float steradians = 0; // one over the chance per steradian; 0 = nothing of the face is seen there
};
// Even over the solid angle: rectangles by Ureña, Fajardo and King 2013, balls by their cone. Discs by their area, and
// from nearby by the square around them, which keeps the sample bounded.
AreaSample sample_area(const AreaShape& shape, vec3 point, vec2 u);

// One over the chance per steradian with which sample_area() picks a direction in which the face is seen, at a
// distance.
float area_steradians(const AreaShape& shape, vec3 point, vec3 direction, float distance);

// Metres to where a ray meets the glowing side; infinite where it does not.
float area_hit(const AreaShape& shape, const Ray& ray);

// Where it glows towards, roughly how much arrives at a point: never 0 where any does.
vec3 rough_arrival(const Light& light, vec3 point);

// Metres from the middle along the axis within which the lamp that stands for it is off by more than a share of the
// light that falls on fog.
double far_enough(const AreaShape& shape, double share);
}
