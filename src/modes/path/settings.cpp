// Rows of the path tracer.
#include "modes/settings_rows.h"

namespace tyndall {
void append_path_rows(std::vector<SettingRow>& rows) {
    rows.push_back(number_row("path.orders", "", 1, all_orders,
                              "most times light scatters, in fog or on surfaces; 1 = once",
                              TYNDALL_FIELD(path.orders)));
    rows.push_back(
        choice_row("path.emission", switches, "light that fog and surfaces give off", TYNDALL_FIELD(path.emission)));
    rows.push_back(choice_row("path.ambient", switches, "the scene's ambient light, as even surroundings far away",
                              TYNDALL_FIELD(path.ambient)));
}
}
