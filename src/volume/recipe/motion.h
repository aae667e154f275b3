// How fast what a recipe shows is advected, at one moment.
#pragma once
#include "volume/recipe/field.h"

#include <span>

namespace tyndall {
struct FogMotion {
    FogField now, before, after; // `step` seconds apart
    float step = 1;
    vec3 wind{0}, rise{0}; // metres per second, of smoke and of flames
};

FogMotion fog_motion(const FogRecipe& recipe, double seconds);

// As recipe_velocity(), at points relative to the field's origin.
void fog_velocity(const FogMotion& motion, std::span<const vec3> points, std::span<const float> kelvin,
                  std::span<vec3> velocity);
}
