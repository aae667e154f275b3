// The kinds of light: those of KHR_lights_punctual and area lights, with the traits of each kind. Their functions are
// in scene/lights.
#pragma once
#include <numbers>
#include <string_view>

namespace tyndall {
enum class LightKind { point, spot, sun, rectangle, disc, sphere };

struct LightTraits {
    std::string_view name, noun; // in scene files and in messages
    std::string_view unit;       // of its intensity
    bool distant = false;        // parallel light from infinity: no position, no falloff
    bool aimed = false;          // shines in a direction
    bool cone = false;           // limited by inner_cone and outer_cone
    bool area = false;           // emits from a surface: scene/lights/area_shape.h
};
inline constexpr LightTraits light_kinds[] = {
    {.name = "point", .noun = "point light", .unit = "candela"},
    {.name = "spot", .noun = "spot", .unit = "candela", .aimed = true, .cone = true},
    {.name = "sun", .noun = "sun", .unit = "lux", .distant = true, .aimed = true},
    {.name = "rectangle", .noun = "rectangle", .unit = "nit", .aimed = true, .area = true},
    {.name = "disc", .noun = "disc", .unit = "nit", .aimed = true, .area = true},
    {.name = "sphere", .noun = "sphere", .unit = "nit", .area = true},
};
constexpr const LightTraits& traits_of(LightKind kind) { return light_kinds[static_cast<int>(kind)]; }

// The least half angle of a spot that single precision resolves: 0.05 degrees, in radians.
inline constexpr float narrowest_cone = 0.05f * std::numbers::pi_v<float> / 180;

// For a Light or a LightSource.
template<class T> constexpr bool is_distant(const T& light) { return traits_of(light.kind).distant; }
template<class T> constexpr bool is_aimed(const T& light) { return traits_of(light.kind).aimed; }
template<class T> constexpr bool has_cone(const T& light) { return traits_of(light.kind).cone; }
template<class T> constexpr bool has_area(const T& light) { return traits_of(light.kind).area; }
template<class T> constexpr bool shines_around(const T& light) { return !is_distant(light) && !has_cone(light); }
}
