// For the row of march in the table.
#pragma once
#include "modes/mode.h"
#include "modes/settings.h"

namespace tyndall {
void append_march_rows(std::vector<SettingRow>& rows);
void set_march_quality(Settings& settings, Quality quality);
std::vector<Rung> march_rungs();
}
