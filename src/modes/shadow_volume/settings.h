// Settings of shadow-volume.
#pragma once
#include "modes/settings.h"

namespace tyndall {
struct Rung;
struct Snapshot;

// How shadow volumes are rendered: the light between them, or their sides as bright sheets.
enum class ShadowDraw { exact, shells };
// How fog is integrated: every medium at its mean density in closed form, or true densities in short steps. `automatic`
// samples if there is a grid.
enum class ShadowFog { automatic, homogeneous, sampled };

struct ShadowVolumeSettings {
    ShadowDraw draw = ShadowDraw::exact;
    ShadowFog fog = ShadowFog::automatic;
    int nodes = 4;                 // Gauss–Legendre nodes on each lit segment of homogeneous fog
    int steps = 24;                // along a ray, where fog is sampled
    float shell_length = 0;        // meters behind the occluder at which a shell has faded out; 0 = half the scene
    float shell_intensity = 0.03f; // a shell is as bright as this fraction of that length of lit fog
};

// Whether fog is sampled in steps instead of integrated in closed form.
bool samples_fog(const Snapshot& snapshot, const ShadowVolumeSettings& settings);

// For the mode's row of the table.
void append_shadow_volume_rows(std::vector<SettingRow>& rows);
void set_shadow_volume_quality(Settings& settings, Quality quality);
std::vector<Rung> shadow_volume_rungs();
}
