// Rows of light that scatters more than once, in march and froxel.
#include "modes/settings_rows.h"

namespace tyndall {
void append_fluence_rows(std::vector<SettingRow>& rows) {
    rows.push_back(
        number_row("fluence.orders", "", 1, all_orders,
                   "most times light scatters in march and froxel, in fog or on surfaces; beyond 1 a grid of "
                   "the light that has scattered before is added to exact single scattering",
                   TYNDALL_FIELD(fluence.orders)));
    rows.push_back(number_row("fluence.resolution", "cells", 4, 256, "cells of that grid along the fog's longest side",
                              TYNDALL_FIELD(fluence.resolution)));
    rows.push_back(number_row("fluence.paths", "", 64, 1e8, "paths of light that fill it: noise falls with their root",
                              TYNDALL_FIELD(fluence.paths)));
}
}
