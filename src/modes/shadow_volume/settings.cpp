// Settings of shadow-volume: rows, presets, and the ladder from fastest to most accurate.
#include "modes/shadow_volume/settings.h"
#include "modes/mode.h"
#include "modes/settings_rows.h"

namespace tyndall {
void append_shadow_volume_rows(std::vector<SettingRow>& rows) {
    rows.push_back(choice_row("shadow_volume.draw", {"exact", "shells"},
                              "exact = fog light integrated between the volumes; shells = their sides as bright sheets",
                              TYNDALL_FIELD(of<ShadowVolumeSettings>().draw)));
    rows.push_back(
        choice_row("shadow_volume.fog", {"auto", "homogeneous", "sampled"},
                   "homogeneous = every medium at its mean density, in closed form; sampled = true densities in "
                   "steps; auto = sampled where there is a grid",
                   TYNDALL_FIELD(of<ShadowVolumeSettings>().fog)));
    rows.push_back(number_row("shadow_volume.nodes", "", 1, 32,
                              "Gauss-Legendre nodes on each lit segment of homogeneous fog",
                              TYNDALL_FIELD(of<ShadowVolumeSettings>().nodes)));
    rows.push_back(number_row("shadow_volume.steps", "", 1, 4096, "steps along a ray where fog is sampled",
                              TYNDALL_FIELD(of<ShadowVolumeSettings>().steps)));
    rows.push_back(number_row("shadow_volume.shell_length", "m", 0, 1e9,
                              "distance behind the occluder at which a shell has faded out; 0 = half the scene's "
                              "diagonal",
                              TYNDALL_FIELD(of<ShadowVolumeSettings>().shell_length)));
    rows.push_back(number_row("shadow_volume.shell_intensity", "", 0, 1e3,
                              "brightness of a shell: that of lit fog over this fraction of shell_length",
                              TYNDALL_FIELD(of<ShadowVolumeSettings>().shell_intensity)));
    mark_advanced(rows, {"draw", "shell_length", "shell_intensity"});
}

void set_shadow_volume_quality(Settings& settings, Quality quality) {
    ShadowVolumeSettings& shadow_volume = settings.of<ShadowVolumeSettings>();
    if (quality == Quality::draft) shadow_volume.nodes = 3, shadow_volume.steps = 16;
    if (quality == Quality::final) shadow_volume.nodes = 6, shadow_volume.steps = 128;
    if (quality == Quality::reference) shadow_volume.nodes = 16, shadow_volume.steps = 1024;
}

std::vector<Rung> shadow_volume_rungs() {
    return {{"", "pixel.samples=1 shadow_volume.nodes=2 shadow_volume.steps=8 terms.light_resolution=32"},
            {"", "pixel.samples=1 shadow_volume.nodes=3 shadow_volume.steps=16 terms.light_resolution=32"},
            {"", "pixel.samples=2 shadow_volume.nodes=4 shadow_volume.steps=24 terms.light_resolution=64"},
            {"", "pixel.samples=4 shadow_volume.nodes=4 shadow_volume.steps=48 terms.light_resolution=64"},
            {"", "pixel.samples=16 shadow_volume.nodes=6 shadow_volume.steps=128 terms.light_resolution=128"},
            {"", "pixel.samples=64 shadow_volume.nodes=8 shadow_volume.steps=256 terms.light_resolution=192"}};
}
}
