// What can be edited, in the words of those who light scenes, and over ranges fit for a hand.
#pragma once
#include "viewer/editing/properties.h"
#include "viewer/state/setting_groups.h"

#include <string>

namespace tyndall {
struct LightSource;
struct MediumSource;

struct PropertyWords {
    const char* label;
    const char* help;         // what it does to the picture
    bool logarithmic = false; // its slider
};
const PropertyWords& words_of(const Property& property);

// As far as a slider goes: where the value is mostly wanted, and with the value itself in it unless it is infinite.
SliderRange slider_range(const Property& property, float value);

// A message about a part of the scene with labels for the names that scene files have.
std::string in_words(Part part, std::string message);

// Where in the sky the light of a sun comes from, degrees: above the horizon, and about the vertical from +z towards
// +x. Close to the zenith the bearing is lost.
struct SunPlace {
    float height = 0, bearing = 0;
};
SunPlace sun_place(vec3 direction);         // the way the light travels, of any length
vec3 direction_from(const SunPlace& place); // of unit length

// Of lights and fog, for people: "spot", "sun", "homogeneous fog".
const char* kind_name(const MediumSource& medium);
}
