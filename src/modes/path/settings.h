// For the row of path in the table.
#pragma once
#include "modes/settings.h"

namespace tyndall {
struct Rung;

void append_path_rows(std::vector<SettingRow>& rows);
std::vector<Rung> path_rungs();
}
