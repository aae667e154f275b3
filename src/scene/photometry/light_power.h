// Converts the units of scene files to candela and lux.
#pragma once
#include "base/math.h"

namespace tyndall {
struct LightSource;

// Lumens that a spot of 1 candela emits in its cone (half angles, radians): the integral of KHR_lights_punctual's
// falloff over the sphere.
double cone_lumens(double inner, double outer);

// Area of the face of a rectangle, disc or sphere projected along its axis, m².
double face_area(const LightSource& light, double seconds);

// Candela (point, spot; with a profile: in its brightest direction; area light: along its axis) or lux (sun), including
// exposure.
float candela_of(const LightSource& light, double seconds);

// The same in the native unit of the light's kind: nit for area lights.
float native_intensity(const LightSource& light, double seconds);

// candela_of() times the light's color, including that of its temperature.
vec3 intensity_of(const LightSource& light, double seconds);
}
