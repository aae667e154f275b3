// Guesses the quantity in a VDB grid from the names and types that programs write.
#pragma once
#include <string_view>

namespace tyndall {
struct VdbGridEntry;

enum class GridRole { density, temperature, flame, emission, color, velocity, level_set, other };
inline constexpr std::string_view grid_role_names[] = {"density", "temperature", "flame",     "emission",
                                                       "color",   "velocity",    "level set", "other"};

// By name alone, ignoring case and anything after a dot; density if the name is not recognized.
GridRole role_of_name(std::string_view name);

// By name, type and class; `other` for types that hold no known quantity.
GridRole role_of(const VdbGridEntry& grid);
}
