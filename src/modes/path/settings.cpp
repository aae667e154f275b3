// Settings of path: rows, and the ladder from fastest to most accurate.
#include "modes/path/settings.h"
#include "modes/mode.h"
#include "modes/settings_rows.h"

namespace tyndall {
void append_path_rows(std::vector<SettingRow>& rows) {
    rows.push_back(number_row("path.orders", "", 1, all_orders,
                              "maximum scattering order, in fog or on surfaces; 1 = single scattering",
                              TYNDALL_FIELD(path.orders)));
}

std::vector<Rung> path_rungs() {
    return {{"", "pixel.samples=1"},  {"", "pixel.samples=4"},   {"", "pixel.samples=16"},
            {"", "pixel.samples=64"}, {"", "pixel.samples=256"}, {"", "pixel.samples=1024"}};
}
}
