// A recipe at one time, prepared for the SIMD kernels. Points are relative to the center of the bounds.
#pragma once
#include "volume/noise/lattice.h"
#include "volume/recipe/recipe.h"

namespace tyndall {
// The fire of a recipe; heights and distances from its base as in FireRecipe.
struct FireField {
    bool burns = false;
    vec3 base{0};
    float per_height = 1, per_radius = 1, taper = 1; // 1/m
    float edge = 0, span = 0, air = 0;               // kelvin; the core is at edge + span
    float flicker = 0;                               // heat per unit of noise
    float per_stretch = 1;                           // scale of y for noise coordinates
    NoiseSum noise;
    float soot = 0;
    float plume_low = 0, plume_rate = 0;      // start height, and ramp per meter above it
    float plume_radius = 1, plume_spread = 0; // meters at the base, and growth per meter above
};

struct FogField {
    dvec3 origin{0}; // center of the bounds
    vec3 half_size{1};
    NoiseSum noise;
    NoiseOctave swirl;
    float swirl_gain = 0;    // meters per unit of curl; 0 = no swirl
    float swirl_reach = 0;   // meters; maximum displacement along any axis
    float swirl_stretch = 0; // Lipschitz bound: maximum change of the displacement per total change of the coordinates
    float threshold = 0.5f, gain = 1, soft_edge = 0;
    vec3 border{0};
    FogShape shape = FogShape::box;
    float shape_strength = 0;
    vec3 shape_center{0}, shape_low_axis{1}, shape_high_axis{1}; // semi-axes toward low and high coordinates
    float height_base = 0, height_rate = 0;                      // · exp(-rate · (y - base))
    FireField fire;
};

// Rounds a speed in turns per second to whole turns per period, at least one; 0 without a period or speed.
double turns_per_loop(const FogRecipe& recipe, double speed);

FogField fog_field(const FogRecipe& recipe, double seconds);

// Displacement of points' coordinates by the swirl, meters.
void recipe_swirl(const FogRecipe& recipe, double seconds, std::span<const vec3> points, std::span<vec3> displacements);
}
