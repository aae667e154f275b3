// What of a light goes where: an IES profile, a gobo, or both, as factors on its intensity by direction.
#pragma once
#include "base/math.h"

#include <memory>

namespace tyndall {
struct Gobo;
struct IesProfile;
struct Light;

// The axes across a light's direction: `up` as far as it is, and to the right of who looks along the light.
struct LightAxes {
    vec3 right{1, 0, 0}, up{0, 1, 0};
};
// Turned counterclockwise as seen from the light, radians. Where the light goes along `up`, -Z takes its place, or else
// X.
LightAxes light_axes(vec3 direction, vec3 up, float turn);

struct LightFilter {
    vec3 direction{0, -1, 0};                  // of the light
    std::shared_ptr<const IesProfile> profile; // null = none
    std::shared_ptr<const Gobo> gobo;          // likewise
    LightAxes profile_axes, gobo_axes;
    vec2 gobo_half{1}; // tangents of the angles from the middle of the picture to its edges
};

// Factors on the intensity in a direction (unit), colours of the gobo included.
dvec3 filtered(const LightFilter& filter, dvec3 direction);

bool has_colors(const LightFilter& filter);

// Radians over which the light may change: of the gobo's texels, of the profile's angles.
float finest_detail(const LightFilter& filter);

// The factors over all directions of a light's cone, weighted with that: their mean, and how far they are off it (root
// mean square of luminance, over the mean).
struct FactorMean {
    vec3 mean{1};
    float spread = 0;
};
FactorMean mean_factor(const Light& light);

// The angle that a light sends light into, radians, from side to side.
float whole_angle(const Light& light);

// The level of its gobo for looks that are this angle (radians) apart; 0 without a gobo.
int blurred_level(const LightFilter& filter, float angle);
}
