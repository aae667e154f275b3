// Settings of march, for the mode's row of the table.
#pragma once
#include "modes/settings.h"

namespace tyndall {
struct Rung;

void append_march_rows(std::vector<SettingRow>& rows);
void set_march_quality(Settings& settings, Quality quality);
std::vector<Rung> march_rungs();
}
