// Area lights: rectangles, discs and spheres that emit the same radiance in every direction; a rectangle's radiance may
// be textured.
#pragma once
#include "scene/light.h"

namespace tyndall {
struct Gobo;

struct AreaShape {
    LightKind kind = LightKind::rectangle;
    vec3 center{0};
    vec3 normal{0, -1, 0}, right{1, 0, 0}, up{0, 0, -1}; // unit; normal: the emitting direction
    vec2 half{0.5f};        // half-extents along right and up, meters; disc and sphere: the radius in both
    bool two_sided = false; // rectangle, disc
    bool visible = true;    // to the camera, from the emitting side
    // Rectangle: texture on the radiance, oriented as a screen shows it to a viewer in front; null = uniform.
    std::shared_ptr<const Gobo> texture;
    vec3 texture_scale{1}; // scales the texture's mean to 1; set by make_punctual()
    vec2 spread{1};        // variance of the emission's position along right and up, relative to a uniform face; set by
                           // make_punctual()
};

// Area of the face projected along its axis, m².
float face_area(const AreaShape& shape);

// Turns `light`, whose position, intensity (candela along the axis) and scales are set, into a point light or spot that
// approximates the shape: at the centroid of its emission, of equal area, with Lambert's cosine and the texture's mean
// color. A shape without area becomes dark.
void make_punctual(const AreaShape& shape, Light& light);

// Radiance of an area light in nits, the mean over its face.
vec3 radiance_of(const Light& light);

// The texture's factor on that radiance at a point of the face; 1 without a texture.
vec3 face_texture(const AreaShape& shape, vec3 at);

// A sampled direction towards a point of the face.
struct AreaSample {
    vec3 direction{0, 1, 0};
    float distance = 0;   // meters
    float steradians = 0; // 1 / pdf over solid angle; 0 = the direction misses the face
};
// Samples from u in [0,1)²: uniform in solid angle for rectangles (Ureña, Fajardo and King 2013) and spheres (their
// cone). Discs are sampled uniformly by area, and from nearby through their bounding square in solid angle, which keeps
// the sample weight bounded.
AreaSample sample_area(const AreaShape& shape, vec3 point, vec2 u);

// 1 / pdf over solid angle with which sample_area() picks `direction`, in which the face is seen at `distance`.
float area_steradians(const AreaShape& shape, vec3 point, vec3 direction, float distance);

// Distance in meters along a ray to the emitting side; infinite on a miss.
float area_hit(const AreaShape& shape, const Ray& ray);

// Rough estimate of the irradiance at a point: never 0 where any light arrives, 0 behind the face.
vec3 rough_irradiance(const Light& light, vec3 point);

// Distance from the center in meters, at up to 80 degrees from the axis, within which the relative error of the
// make_punctual() approximation exceeds `share` for the light that falls on fog.
double far_distance(const AreaShape& shape, double share);
}
