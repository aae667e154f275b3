// Settings of shadow-map: rows, presets, and the ladder from fastest to most accurate.
#include "modes/shadow_map/settings.h"
#include "modes/mode.h"
#include "modes/settings_rows.h"

namespace tyndall {
void append_shadow_map_rows(std::vector<SettingRow>& rows) {
    rows.push_back(
        number_row("shadow_map.steps", "", 1, 1024,
                   "steps along each ray through the fog, and as many along the part that each local light reaches",
                   TYNDALL_FIELD(of<ShadowMapSettings>().steps)));
    rows.push_back(
        choice_row("shadow_map.spacing", {"angle", "distance"},
                   "spacing of steps for local lights: uniform in the angle around the light, or uniform along the ray",
                   TYNDALL_FIELD(of<ShadowMapSettings>().spacing)));
    rows.push_back(
        number_row("shadow_map.resolution", "texels", 16, 8192,
                   "texels across each shadow map (like the other map settings, also used by march.visibility=maps)",
                   TYNDALL_FIELD(of<ShadowMapSettings>().resolution)));
    rows.push_back(number_row("shadow_map.cascades", "", 1, 4,
                              "maximum number of shadow-map cascades per sun; fewer where more would gain nothing",
                              TYNDALL_FIELD(of<ShadowMapSettings>().cascades)));
    rows.push_back(number_row("shadow_map.pcf", "", 0, 2,
                              "filtering of shadow edges: 0 = nearest texel, 1 = four texels, 2 = sixteen texels",
                              TYNDALL_FIELD(of<ShadowMapSettings>().pcf)));
    rows.push_back(number_row("shadow_map.bias", "texels", 0, 64,
                              "moves surfaces away from the light; fog needs no bias, and light leaks by as much",
                              TYNDALL_FIELD(of<ShadowMapSettings>().bias)));
    rows.push_back(
        choice_row("shadow_map.fog_resolution", resolutions,
                   "resolution of the fog's light along each side, with depth-aware upsampling to the full image",
                   TYNDALL_FIELD(of<ShadowMapSettings>().fog_resolution)));
    rows.push_back(choice_row("shadow_map.blur", switches,
                              "smooths the jitter pattern over 4x4 pixels of similar depth (with one ray per pixel)",
                              TYNDALL_FIELD(of<ShadowMapSettings>().blur)));
    mark_advanced(rows, {"spacing", "cascades", "pcf", "bias", "blur"});
}

void set_shadow_map_quality(Settings& settings, Quality quality) {
    ShadowMapSettings& shadow_map = settings.of<ShadowMapSettings>();
    if (quality == Quality::draft) shadow_map.steps = 16, shadow_map.resolution = 256;
    if (quality == Quality::final) shadow_map.steps = 64, shadow_map.resolution = 2048, shadow_map.pcf = 1;
    if (quality == Quality::reference) shadow_map.steps = 256, shadow_map.resolution = 4096, shadow_map.pcf = 1;
}

std::vector<Rung> shadow_map_rungs() {
    return {
        {"", "pixel.samples=1 shadow_map.steps=8 shadow_map.resolution=256 terms.light_resolution=32"},
        {"", "pixel.samples=1 shadow_map.steps=16 shadow_map.resolution=256 terms.light_resolution=32"},
        {"", "pixel.samples=2 shadow_map.steps=24 shadow_map.resolution=512 terms.light_resolution=64"},
        {"",
         "pixel.samples=4 shadow_map.steps=48 shadow_map.resolution=1024 shadow_map.pcf=1 terms.light_resolution=64"},
        {"",
         "pixel.samples=16 shadow_map.steps=64 shadow_map.resolution=2048 shadow_map.pcf=1 terms.light_resolution=128"},
        {"", "pixel.samples=64 shadow_map.steps=128 shadow_map.resolution=4096 shadow_map.pcf=1 "
             "terms.light_resolution=192"}};
}
}
