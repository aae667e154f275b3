// Settings of path, for the mode's row of the table.
#pragma once
#include "modes/settings.h"

namespace tyndall {
struct Rung;

void append_path_rows(std::vector<SettingRow>& rows);
std::vector<Rung> path_rungs();
}
