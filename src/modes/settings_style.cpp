// Rows of the artist's controls.
#include "modes/settings_rows.h"

namespace tyndall {
void append_style_rows(std::vector<SettingRow>& rows) {
    rows.push_back(number_row("style.light_depth", "", 0, 10,
                              "factor on the optical depth between light and fog; below 1, shafts reach further",
                              TYNDALL_FIELD(style.light_depth)));
    rows.push_back(number_row("style.view_depth", "", 0, 10,
                              "factor on the optical depth between fog and eye, for the fog's own light; above 1, "
                              "shafts are clearer",
                              TYNDALL_FIELD(style.view_depth)));
    rows.push_back(
        number_row("style.density", "", 0, 1000, "factor on every medium's extinction", TYNDALL_FIELD(style.density)));
    rows.push_back(number_row("style.range", "m", 0.01, 1e6,
                              "distance from the eye at which the fog's light has faded out, over its last fifth",
                              TYNDALL_FIELD(style.range)));
    rows.push_back(color_row("style.tint", "", 0, 100, "factor on the fog's light, R,G,B", TYNDALL_FIELD(style.tint)));
}
}
