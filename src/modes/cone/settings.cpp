// Settings of cone: rows, presets, and the ladder from fastest to most accurate.
#include "modes/cone/settings.h"
#include "modes/mode.h"
#include "modes/settings_rows.h"

namespace tyndall {
void append_cone_rows(std::vector<SettingRow>& rows) {
    rows.push_back(number_row("cone.nodes", "", 2, 32,
                              "quadrature nodes on the widest segments of a ray; narrow and thin ones use fewer",
                              TYNDALL_FIELD(of<ConeSettings>().nodes)));
    rows.push_back(number_row("cone.near_radius", "m", 0, 1e9,
                              "radius of a spot's lens: its light begins where the cone is that wide",
                              TYNDALL_FIELD(of<ConeSettings>().near_radius)));
    rows.push_back(choice_row("cone.attenuation", {"inverse_square", "linear", "none"},
                              "attenuation of local lights with distance; linear = from the intensity at 1 m to 0 at "
                              "the light's range (or the scene's diagonal), none = as at 1 m everywhere within range",
                              TYNDALL_FIELD(of<ConeSettings>().attenuation)));
    rows.push_back(choice_row("cone.edge", {"physical", "soft"},
                              "falloff at the edge of spots; physical = the light's inner and outer cone, soft = "
                              "smoothstep in the angle, from cone.inner times the outer cone to the outer cone",
                              TYNDALL_FIELD(of<ConeSettings>().edge)));
    rows.push_back(number_row("cone.inner", "", 0, 1,
                              "with a soft edge: fraction of the outer cone's angle that is lit uniformly",
                              TYNDALL_FIELD(of<ConeSettings>().inner)));
    rows.push_back(number_row("cone.noise", "", 0, 1, "amount by which drifting noise modulates local lights",
                              TYNDALL_FIELD(of<ConeSettings>().noise)));
    rows.push_back(number_row("cone.noise_size", "m", 1e-6, 1e9, "size of the largest features of the noise",
                              TYNDALL_FIELD(of<ConeSettings>().noise_size)));
    rows.push_back(number_row("cone.noise_speed", "m/s", -1e9, 1e9, "speed at which the noise rises",
                              TYNDALL_FIELD(of<ConeSettings>().noise_speed)));
    rows.push_back(
        choice_row("cone.resolution", resolutions,
                   "resolution of the fog's light along each side, with depth-aware upsampling to the full image",
                   TYNDALL_FIELD(of<ConeSettings>().resolution)));
    mark_advanced(rows, {"near_radius", "attenuation", "edge", "inner", "noise", "noise_size", "noise_speed"});
}

void set_cone_quality(Settings& settings, Quality quality) {
    ConeSettings& cone = settings.of<ConeSettings>();
    if (quality == Quality::draft) cone.nodes = 6;
    if (quality == Quality::reference) cone.nodes = 16;
}

std::vector<Rung> cone_rungs() {
    return {{"", "pixel.samples=1 cone.nodes=4 cone.resolution=third"},
            {"", "pixel.samples=1 cone.nodes=4 cone.resolution=half"},
            {"", "pixel.samples=1 cone.nodes=6"},
            {"", "pixel.samples=4 cone.nodes=8"},
            {"", "pixel.samples=16 cone.nodes=12"},
            {"", "pixel.samples=64 cone.nodes=16"}};
}
}
