// Labels, help and slider ranges of the properties that can be edited.
#pragma once
#include "viewer/editing/properties.h"
#include "viewer/state/setting_groups.h"

#include <string>

namespace tyndall {
struct LightSource;
struct MediumSource;

struct PropertyWords {
    const char* label;
    const char* help;         // its effect on the image
    bool logarithmic = false; // the slider's scale
};
const PropertyWords& words_of(const Property& property);

// The range of a slider: the usual range, extended to include the value unless that is infinite.
SliderRange slider_range(const Property& property, float value);

// A message about a part of the scene, with the names of scene files replaced by labels.
std::string with_labels(Part part, std::string message);

// The position of a sun in the sky, degrees: elevation above the horizon, and azimuth about the vertical from +z
// towards +x, which is undefined at the zenith.
struct SunAngles {
    float height = 0, azimuth = 0;
};
SunAngles sun_angles(vec3 direction);         // direction of travel, of any length
vec3 direction_from(const SunAngles& angles); // of unit length

// The displayed name of a medium's kind: "homogeneous fog".
const char* kind_name(const MediumSource& medium);
}
