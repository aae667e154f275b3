// Describes a grid of a volume file in words.
#pragma once
#include "volume/vdb/vdb.h"

namespace tyndall {
// "0.1 0.2 0.3": for people.
std::string vector_text(vec3 value);
std::string place_text(vec3 place, dvec3 origin); // world position of a place relative to `origin`

ivec3 voxels_across(const VdbGridInfo& grid);

// World box of the active voxels, their whole cells included.
Box world_bounds(const VdbGridInfo& grid);

// "float, fog volume, usable as fog".
std::string kind_text(const VdbGridInfo& grid);

// Names and values: active voxels, extent, world, axes, values, faults; those that do not apply are left out.
std::vector<std::pair<std::string, std::string>> grid_rows(const VdbGridInfo& grid);
}
