// What a grid of a VDB file looks like, by the names and types that programs write.
#pragma once
#include <string_view>

namespace tyndall {
struct VdbGridEntry;

enum class GridRole { density, temperature, flame, emission, color, velocity, level_set, other };
inline constexpr std::string_view grid_role_names[] = {"density", "temperature", "flame",     "emission",
                                                       "color",   "velocity",    "level set", "other"};

// By its name alone, however it is written and whatever follows a dot; density where it says nothing else.
GridRole role_of_name(std::string_view name);

// By name, type and class; `other` for types that hold no quantity that is known.
GridRole role_of(const VdbGridEntry& grid);
}
