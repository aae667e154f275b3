// Directional factors on a light's intensity: an IES profile, a gobo, or both.
#pragma once
#include "base/math.h"

#include <memory>

namespace tyndall {
struct Gobo;
struct IesProfile;
struct Light;

// The axes perpendicular to a light's direction: closest to `up`, and to the right when looking along the light.
struct LightAxes {
    vec3 right{1, 0, 0}, up{0, 1, 0};
};
// Rotated by `turn` radians counterclockwise as seen from the light. If the light points along `up`, -Z is used
// instead, or else X.
LightAxes light_axes(vec3 direction, vec3 up, float turn);

struct LightFilter {
    vec3 direction{0, -1, 0};                  // of the light
    std::shared_ptr<const IesProfile> profile; // null = none
    std::shared_ptr<const Gobo> gobo;          // likewise
    LightAxes profile_axes, gobo_axes;
    vec2 gobo_half{1}; // tangents of the angles from the center of the image to its edges
};

// Factors on the intensity in a unit direction, including the gobo's color.
dvec3 filtered(const LightFilter& filter, dvec3 direction);

bool has_colors(const LightFilter& filter);

// The smallest angle over which the light may change, radians: a texel of the gobo or a step of the profile.
float finest_detail(const LightFilter& filter);

// The factors over all directions of a light's cone, weighted by its falloff: their mean, and the standard deviation of
// their luminance over its mean.
struct FactorMean {
    vec3 mean{1};
    float spread = 0;
};
FactorMean mean_factor(const Light& light);

// Full angle of the light's cone, radians; 2π without a cone.
float cone_angle(const Light& light);

// The gobo's mip level for lookups this angle (radians) apart; 0 without a gobo.
int gobo_mip_level(const LightFilter& filter, float angle);
}
