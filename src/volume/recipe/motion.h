// Velocity of a recipe's fog at one time.
#pragma once
#include "volume/recipe/field.h"

#include <span>

namespace tyndall {
struct FogMotion {
    FogField now, before, after; // `step` seconds apart
    float step = 1;
    vec3 wind{0}, rise{0}; // meters per second, for smoke and for flames
};

FogMotion fog_motion(const FogRecipe& recipe, double seconds);

// recipe_velocity() at points relative to the field's origin.
void fog_velocity(const FogMotion& motion, std::span<const vec3> points, std::span<const float> kelvin,
                  std::span<vec3> velocity);
}
