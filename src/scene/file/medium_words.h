// What to write in a scene file for the grids of a volume file.
#pragma once
#include "volume/vdb/vdb.h"

#include <filesystem>
#include <string>

namespace tyndall {
// An entry of "media" that takes each grid as what it looks like: density, color, temperature and flame, or emission,
// and velocity.
// Where there is no density, nothing is dimmed; empty where no grid is of use.
std::string medium_text(const std::filesystem::path& vdb, const VdbInfo& info);

// Extinction at which the longest way through the densest fog lets 2 % of the light pass, 1/m.
float usual_extinction(const VdbGridInfo& fog);
}
