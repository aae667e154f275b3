// Rows of the march with shadow maps.
#include "modes/settings_rows.h"

namespace tyndall {
void append_shadow_map_rows(std::vector<SettingRow>& rows) {
    rows.push_back(number_row("shadow_map.steps", "", 1, 1024,
                              "steps along each ray through the fog, and as many along what each local light reaches",
                              TYNDALL_FIELD(shadow_map.steps)));
    rows.push_back(number_row("shadow_map.lookups", "", 1, 64,
                              "points of each step whose shadows are looked up: narrow shafts need more than fog does",
                              TYNDALL_FIELD(shadow_map.lookups)));
    rows.push_back(choice_row("shadow_map.spacing", {"angle", "distance"},
                              "steps of local lights: even in the angle around the light, or even along the ray",
                              TYNDALL_FIELD(shadow_map.spacing)));
    rows.push_back(number_row("shadow_map.resolution", "texels", 16, 8192,
                              "texels across each shadow map (also of march.visibility=maps, as the rows below)",
                              TYNDALL_FIELD(shadow_map.resolution)));
    rows.push_back(number_row("shadow_map.cascades", "", 1, 4,
                              "most shadow maps of a sun, one behind the other; fewer where the scene gains nothing",
                              TYNDALL_FIELD(shadow_map.cascades)));
    rows.push_back(number_row("shadow_map.pcf", "", 0, 2,
                              "smoothing of shadow edges: 0 nearest texel, 1 the four around, 2 sixteen",
                              TYNDALL_FIELD(shadow_map.pcf)));
    rows.push_back(number_row("shadow_map.bias", "texels", 0, 64,
                              "moves surfaces away from the light; fog needs none, and light leaks by as much",
                              TYNDALL_FIELD(shadow_map.bias)));
    rows.push_back(choice_row("shadow_map.light", {"off", "average", "froxel", "grid", "marched"},
                              "fog between light and fog, as march.light; cells: march.light_resolution",
                              TYNDALL_FIELD(shadow_map.light)));
    rows.push_back(choice_row("shadow_map.picture", picture_shares,
                              "resolution of the fog's light along each side; it is spread over the whole picture with "
                              "regard to depth",
                              TYNDALL_FIELD(shadow_map.picture)));
    rows.push_back(choice_row("shadow_map.blur", switches,
                              "smooths the jitter's pattern over 4x4 pixels of like depth (of one ray per pixel)",
                              TYNDALL_FIELD(shadow_map.blur)));
}
}
