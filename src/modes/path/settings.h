// For the row of path in the table.
#pragma once
#include "modes/mode.h"
#include "modes/settings.h"

namespace tyndall {
void append_path_rows(std::vector<SettingRow>& rows);
std::vector<Rung> path_rungs();
}
