// Rows of shadow volumes.
#include "modes/settings_rows.h"

namespace tyndall {
void append_shadow_volume_rows(std::vector<SettingRow>& rows) {
    rows.push_back(choice_row("shadow_volume.draw", {"exact", "shells"},
                              "exact = fog light integrated between the volumes; shells = their sides as bright sheets",
                              TYNDALL_FIELD(shadow_volume.draw)));
    rows.push_back(choice_row("shadow_volume.fog", {"auto", "even", "sampled"},
                              "even = every medium at its mean density, in closed form; sampled = true densities in "
                              "steps; auto = sampled where there is a grid",
                              TYNDALL_FIELD(shadow_volume.fog)));
    rows.push_back(number_row("shadow_volume.nodes", "", 1, 32, "Gauss-Legendre nodes on each lit stretch of even fog",
                              TYNDALL_FIELD(shadow_volume.nodes)));
    rows.push_back(number_row("shadow_volume.steps", "", 1, 4096, "steps along a ray where fog is sampled",
                              TYNDALL_FIELD(shadow_volume.steps)));
    rows.push_back(number_row("shadow_volume.light_resolution", "cells", 4, 1024,
                              "cells across the fog in the light's grid where fog is sampled",
                              TYNDALL_FIELD(shadow_volume.light_resolution)));
    rows.push_back(number_row("shadow_volume.shell_length", "m", 0, 1e6,
                              "distance behind the occluder at which a shell has faded out; 0 = half the scene's "
                              "diagonal",
                              TYNDALL_FIELD(shadow_volume.shell_length)));
    rows.push_back(number_row("shadow_volume.shell_intensity", "", 0, 1e3,
                              "a shell is as bright as this share of shell_length of lit fog",
                              TYNDALL_FIELD(shadow_volume.shell_intensity)));
}
}
