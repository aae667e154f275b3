#include "volume/recipe/field.h"

#include <numbers>

namespace tyndall {
namespace {
constexpr uint32_t swirl_salt = 0x517cc1b7u, second_layer_salt = 0x2545f491u, fire_salt = 0x9e3779b9u;

// Phase of a looping recipe, 0 <= phase < 1.
double loop_phase(const FogRecipe& recipe, double seconds) {
    return wrapped_turn(std::fmod(seconds, recipe.period) / recipe.period);
}

// Rotation of the gradients at a time, 0 <= turn < 1.
double turn_at(const FogRecipe& recipe, double seconds, double speed) {
    if (recipe.period <= 0) return wrapped_turn(speed * seconds);
    return wrapped_turn(turns_per_loop(recipe, speed) * loop_phase(recipe, seconds));
}

// Layers of noise that evolves and is advected by a wind in meters per second. Pure advection loops only if the fog
// repeats in space every wind · period meters. Loops therefore crossfade two independent layers half a period apart,
// each advected at the wind's speed and with zero weight when it jumps back.
std::vector<NoiseLayer> layers(const FogRecipe& recipe, double evolve, dvec3 wind, double seconds) {
    const double turn = turn_at(recipe, seconds, evolve);
    if (wind == dvec3(0)) return {{.turn = turn}};
    if (recipe.period <= 0) return {{.turn = turn, .displacement = wind * seconds}};
    std::vector<NoiseLayer> result;
    for (const uint32_t salt : {0u, second_layer_salt}) {
        const double phase = wrapped_turn(loop_phase(recipe, seconds) + (salt ? 0.5 : 0.0));
        const double sine = std::sin(std::numbers::pi * phase);
        if (phase == 0) continue;
        result.push_back({.turn = turn,
                          .displacement = wind * (recipe.period * (phase - 0.5)),
                          .weight = static_cast<float>(sine * sine),
                          .salt = salt});
    }
    return result;
}

void add_swirl(FogField& field, const FogRecipe& recipe, double seconds) {
    if (recipe.swirl == 0) return;
    const double frequency = 1 / double{recipe.swirl_scale};
    field.swirl = noise_octave(frequency, recipe.noise.seed ^ swirl_salt, turn_at(recipe, seconds, recipe.swirl_speed),
                               field.origin);
    // Each of the curl's three components is a difference of two partial derivatives.
    field.swirl_gain = recipe.swirl / (std::sqrt(6.0f) * noise_slope_spread);
    field.swirl_reach = std::abs(field.swirl_gain) * 2 * noise_slope_peak;
    field.swirl_stretch =
        std::abs(field.swirl_gain) * static_cast<float>(frequency) * (noise_bend_peak + noise_twist_peak);
}

void add_fire(FogField& field, const FogRecipe& recipe, const FireRecipe& fire, double seconds) {
    FireField& f = field.fire;
    f.burns = true;
    f.base = vec3(dvec3(fire.base) - field.origin);
    f.per_height = 1 / fire.height, f.per_radius = 1 / fire.radius, f.taper = fire.taper;
    f.edge = fire.edge, f.span = fire.core - fire.edge, f.air = fire.air;
    f.soot = fire.soot;

    // Lattices are isotropic: noise stretched vertically is isotropic noise of scaled y coordinates.
    const double lower = 1 / double{fire.stretch};
    FractalNoise noise = fire.noise;
    noise.seed ^= fire_salt;
    const dvec3 origin(field.origin.x, field.origin.y * lower, field.origin.z);
    f.noise = noise_sum(noise, layers(recipe, noise.evolve, dvec3(0, fire.rise * lower, 0), seconds), origin);
    f.flicker = fire_noise_gain * fire.flicker, f.per_stretch = static_cast<float>(lower);

    f.plume_low = f.base.y + fire.smoke_start * fire.height, f.plume_rate = 2 / fire.height;
    f.plume_radius = fire.radius, f.plume_spread = fire.smoke_spread;
}
}

double turns_per_loop(const FogRecipe& recipe, double speed) {
    if (speed == 0 || recipe.period <= 0) return 0;
    return std::copysign(std::max(1.0, std::round(std::abs(speed) * recipe.period)), speed);
}

FogField fog_field(const FogRecipe& recipe, double seconds) {
    FogField field;
    const dvec3 low(recipe.bounds.low), high(recipe.bounds.high);
    field.origin = 0.5 * (low + high);
    field.half_size = vec3(0.5 * (high - low));
    field.noise =
        noise_sum(recipe.noise, layers(recipe, recipe.noise.evolve, dvec3(recipe.wind), seconds), field.origin);
    add_swirl(field, recipe, seconds);

    field.threshold = recipe.threshold, field.gain = recipe.gain;
    field.soft_edge = recipe.soft_edge, field.border = recipe.border;
    field.shape = recipe.shape, field.shape_strength = recipe.shape_strength;
    field.shape_center.y = (2 * recipe.shape_level - 1) * field.half_size.y;
    field.shape_low_axis = field.half_size + field.shape_center;
    field.shape_high_axis = field.half_size - field.shape_center;
    field.height_base = static_cast<float>(recipe.height_base - field.origin.y);
    field.height_rate = recipe.height_falloff > 0 ? 1 / recipe.height_falloff : 0;
    if (recipe.fire) add_fire(field, recipe, *recipe.fire, seconds);
    return field;
}
}
