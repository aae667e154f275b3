// What is known of a grid of a volume file, in words.
#pragma once
#include "volume/vdb/vdb.h"

namespace tyndall {
// "0.1 0.2 0.3": for people.
std::string vector_text(vec3 value);
std::string place_text(vec3 place, dvec3 origin); // counted from an origin, in the world

ivec3 voxels_across(const VdbGridInfo& grid);

// World box of the active voxels, their whole cells included.
Box world_bounds(const VdbGridInfo& grid);

// "float, fog volume, usable as fog".
std::string kind_text(const VdbGridInfo& grid);

// Name and value: active voxels, extent, world, axes, values, faults, as far as there is something to say.
std::vector<std::pair<std::string, std::string>> grid_rows(const VdbGridInfo& grid);
}
