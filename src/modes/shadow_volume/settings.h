// Settings of shadow volumes.
#pragma once
#include "modes/settings.h"

namespace tyndall {
struct Rung;
struct Snapshot;

// What shadow volumes are drawn as: the light between them, or their sides themselves as bright sheets.
enum class ShadowDraw { exact, shells };
// The fog that is integrated: every medium at its mean density in closed form, or the true densities in short steps.
// `automatic` samples where there is a grid.
enum class ShadowFog { automatic, homogeneous, sampled };

struct ShadowVolumeSettings {
    ShadowDraw draw = ShadowDraw::exact;
    ShadowFog fog = ShadowFog::automatic;
    int nodes = 4;                 // Gauss–Legendre nodes on each lit stretch of homogeneous fog
    int steps = 24;                // along a ray, where fog is sampled
    float shell_length = 0;        // metres behind the occluder at which a shell has faded out; 0 = half the scene
    float shell_intensity = 0.03f; // share of that length: the depth of lit fog a shell is as bright as
};

// Whether fog is sampled and not integrated in closed form.
bool samples_fog(const Snapshot& snapshot, const ShadowVolumeSettings& settings);

// For its row of the table.
void append_shadow_volume_rows(std::vector<SettingRow>& rows);
void set_shadow_volume_quality(Settings& settings, Quality quality);
std::vector<Rung> shadow_volume_rungs();
}
