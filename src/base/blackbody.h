// The colour of glowing bodies.
#pragma once
#include "base/math.h"

namespace tyndall {
// Of a blackbody at a temperature in kelvin: linear Rec.709 of luminance 1, by Planck's law and the CIE 1931 curves.
// What lies outside of Rec.709 (blue below some 1900 K) is mixed with grey until no channel is below 0.
vec3 blackbody_color(float kelvin);
}
