// What can be edited, in the words of those who light scenes, and over ranges fit for a hand.
#pragma once
#include "preview/properties.h"
#include "preview/setting_groups.h"

namespace tyndall {
struct PropertyWords {
    const char* label;
    const char* help;         // what it does to the picture
    bool logarithmic = false; // its slider
};
const PropertyWords& words_of(const Property& property);

// As far as a slider goes: where the value is mostly wanted, and with the value itself in it unless it is infinite.
SliderRange slider_range(const Property& property, float value);

// Of lights and fog, for people: "spot", "sun", "even fog".
const char* kind_name(const LightSource& light);
const char* kind_name(const MediumSource& medium);
}
