// From the units that people have to candela and lux.
#pragma once
#include "base/math.h"

namespace tyndall {
struct LightSource;

// Lumens that a spot of 1 candela sends through its cone (half angles, radians): the integral of KHR_lights_punctual's
// falloff over the sphere.
double cone_lumens(double inner, double outer);

// Square metres of the face of a rectangle, disc or sphere, as seen along its axis.
double face_area(const LightSource& light, double seconds);

// Candela (point, spot; with a profile: in its brightest direction; of a face: along its axis) or lux (sun), exposure
// in.
float candela_of(const LightSource& light, double seconds);

// The same in the unit of the light's kind: of a face nit.
float native_intensity(const LightSource& light, double seconds);

// The same with the light's colour, that of its temperature included.
vec3 intensity_of(const LightSource& light, double seconds);
}
