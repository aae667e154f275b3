// Scene file entries for the grids of a volume file.
#pragma once
#include "volume/vdb/vdb.h"

#include <filesystem>
#include <string>

namespace tyndall {
// An entry of "media" with the guessed role of each grid: density, color, temperature and flame, or emission, and
// velocity. The extinction is 0 without a density grid, and left to the file if that states one; empty if no grid is
// usable.
std::string medium_text(const std::filesystem::path& vdb, const VdbInfo& info);

// The "grids" of a medium of another file that the velocities of this one move; empty unless this one has nothing else.
std::string velocity_text(const std::filesystem::path& vdb, const VdbInfo& info);

// Whether a medium of the file has an extinction if its entry names none.
bool states_extinction(const VdbInfo& info);

// Extinction at which 2 % of the light passes along the longest path through fog of maximum density, 1/m.
float default_extinction(const VdbGridInfo& fog);
}
