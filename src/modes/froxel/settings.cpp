// Settings of froxel: rows, presets, and the ladder from fastest to most accurate.
#include "modes/froxel/settings.h"
#include "modes/mode.h"
#include "modes/settings_rows.h"

#include <algorithm>

namespace tyndall {
FroxelSettings with_tile(FroxelSettings settings, ivec2 size) {
    constexpr float lines = 360;
    const float share = std::min(static_cast<float>(size.y) / lines, 1.0f);
    settings.tile = std::max(static_cast<int>(static_cast<float>(settings.tile) * share * share), 1);
    return settings;
}

void append_froxel_rows(std::vector<SettingRow>& rows) {
    rows.push_back(number_row("froxel.tile", "pixels", 1, 64,
                              "width and height of a froxel in the image; in images of fewer than 360 lines, less: at "
                              "180, a quarter; never below 1",
                              TYNDALL_FIELD(of<FroxelSettings>().tile)));
    rows.push_back(number_row("froxel.depth_slices", "", 1, 4096,
                              "froxels in depth, from the nearest fog in view to the farthest depth needed",
                              TYNDALL_FIELD(of<FroxelSettings>().depth_slices)));
    rows.push_back(number_row("froxel.depth_growth", "", 0.1, 256,
                              "thickness of the last slice relative to the first; 1 = all equal",
                              TYNDALL_FIELD(of<FroxelSettings>().depth_growth)));
    rows.push_back(choice_row(
        "froxel.visibility", {"off", "rays", "intervals"},
        "shadows of surfaces in the fog; rays = sampled in each froxel; intervals = found exactly: for suns on "
        "the line through each froxel's center, for lamps on every camera ray if their shadow volumes fit "
        "in 1 GiB",
        TYNDALL_FIELD(of<FroxelSettings>().visibility)));
    rows.push_back(number_row(
        "froxel.shadow_rays", "", 1, 256,
        "points per froxel at which light and fog are sampled; with intervals, points on a soft sun, or on a "
        "soft lamp without shadows on every camera ray",
        TYNDALL_FIELD(of<FroxelSettings>().shadow_rays)));
    rows.push_back(choice_row("froxel.lookup", {"trilinear", "tricubic", "jittered"},
                              "interpolation between froxels; tricubic = smoother, jittered = grain instead of cells",
                              TYNDALL_FIELD(of<FroxelSettings>().lookup)));
    rows.push_back(number_row("froxel.history", "", 0, 0.99,
                              "weight of earlier frames (with --history, and in the viewer)",
                              TYNDALL_FIELD(of<FroxelSettings>().history)));
    rows.push_back(choice_row("froxel.amortize", switches,
                              "with a history, relight only a quarter of the froxels in each frame",
                              TYNDALL_FIELD(of<FroxelSettings>().amortize)));
    mark_advanced(rows, {"depth_growth", "amortize"});
}

void set_froxel_quality(Settings& settings, Quality quality) {
    FroxelSettings& froxel = settings.of<FroxelSettings>();
    if (quality == Quality::draft) froxel.tile = 16, froxel.depth_slices = 48;
    if (quality == Quality::final) froxel.tile = 2, froxel.depth_slices = 160, froxel.shadow_rays = 4;
    if (quality == Quality::reference) froxel.tile = 1, froxel.depth_slices = 768, froxel.shadow_rays = 16;
}

std::vector<Rung> froxel_rungs() {
    return {
        {"", "pixel.samples=1 froxel.tile=24 froxel.depth_slices=32 froxel.shadow_rays=1 terms.light_resolution=32"},
        {"", "pixel.samples=1 froxel.tile=16 froxel.depth_slices=48 froxel.shadow_rays=1 terms.light_resolution=32"},
        {"", "pixel.samples=1 froxel.tile=8 froxel.depth_slices=64 froxel.shadow_rays=1 terms.light_resolution=64"},
        {"", "pixel.samples=4 froxel.tile=4 froxel.depth_slices=96 froxel.shadow_rays=2 terms.light_resolution=96"},
        {"", "pixel.samples=16 froxel.tile=2 froxel.depth_slices=160 froxel.shadow_rays=4 terms.light_resolution=128"},
        {"", "pixel.samples=32 froxel.tile=2 froxel.depth_slices=256 froxel.shadow_rays=8 terms.light_resolution=192"}};
}
}
