// A recipe at one moment, prepared for the vector kernels. Points are relative to the middle of the bounds.
#pragma once
#include "volume/noise/lattice.h"
#include "volume/recipe/recipe.h"

namespace tyndall {
// Of the fire in it; heights and distances from its base as in FireRecipe.
struct FireField {
    bool burns = false;
    vec3 base{0};
    float per_height = 1, per_radius = 1, taper = 1; // 1/m
    float edge = 0, span = 0, air = 0;               // kelvin; the core is edge + span
    float flicker = 0;                               // heat per noise
    float per_stretch = 1;                           // noise coordinates are lower by this
    NoiseSum noise;
    float soot = 0;
    float plume_low = 0, plume_rate = 0;      // sets in from this y on, per metre
    float plume_radius = 1, plume_spread = 0; // metres at the base, and per metre above it
};

struct FogField {
    dvec3 origin{0}; // middle of the bounds
    vec3 half_size{1};
    NoiseSum noise;
    NoiseOctave swirl;
    float swirl_gain = 0;    // metres per unit of curl; 0 = still coordinates
    float swirl_reach = 0;   // metres no coordinate is displaced further than, along any axis
    float swirl_stretch = 0; // no displacement changes by more than this times the change of the three coordinates
    float threshold = 0.5f, gain = 1, soft_edge = 0;
    vec3 border{0};
    FogShape shape = FogShape::box;
    float shape_strength = 0;
    vec3 shape_center{0}, shape_low_axis{1}, shape_high_axis{1}; // half axes towards low and high coordinates
    float height_base = 0, height_rate = 0;                      // · exp(-rate · (y - base))
    FireField fire;
};

// What a repeating recipe makes of a speed in turns per second: whole turns per period, at least one.
double turns_per_loop(const FogRecipe& recipe, double speed);

FogField fog_field(const FogRecipe& recipe, double seconds);

// How far the swirl displaces the coordinates of points, metres.
void recipe_swirl(const FogRecipe& recipe, double seconds, std::span<const vec3> points, std::span<vec3> displacements);
}
