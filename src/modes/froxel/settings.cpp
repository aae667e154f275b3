// Rows of the froxel cache.
#include "modes/settings_rows.h"

namespace tyndall {
void append_froxel_rows(std::vector<SettingRow>& rows) {
    rows.push_back(number_row("froxel.tile", "pixels", 1, 64, "width and height of a froxel in the picture",
                              TYNDALL_FIELD(froxel.tile)));
    rows.push_back(number_row("froxel.depth_slices", "", 1, 4096,
                              "froxels in depth, from the nearest fog in view to "
                              "the farthest depth that is needed",
                              TYNDALL_FIELD(froxel.depth_slices)));
    rows.push_back(number_row("froxel.depth_growth", "", 0.1, 256,
                              "how many times as thick the last slice is as the first; 1 = all the same",
                              TYNDALL_FIELD(froxel.depth_growth)));
    rows.push_back(choice_row("froxel.visibility", {"off", "rays", "slices"},
                              "shadows of surfaces in the fog; rays = sampled in each froxel, slices = the exact lit "
                              "share of the line through its middle",
                              TYNDALL_FIELD(froxel.visibility)));
    rows.push_back(number_row("froxel.shadow_rays", "", 1, 256,
                              "points of each froxel at which light and fog are sampled; with slices, points of a "
                              "soft light",
                              TYNDALL_FIELD(froxel.shadow_rays)));
    rows.push_back(choice_row("froxel.lookup", {"trilinear", "tricubic", "jittered"},
                              "how pixels are found between froxels; tricubic = smoother, jittered = grain instead of "
                              "cells",
                              TYNDALL_FIELD(froxel.lookup)));
    rows.push_back(number_row("froxel.history", "", 0, 0.99, "weight of the frames before, where there are any",
                              TYNDALL_FIELD(froxel.history)));
    rows.push_back(choice_row("froxel.amortise", switches,
                              "with a history, light only a quarter of the froxels anew "
                              "in each frame",
                              TYNDALL_FIELD(froxel.amortise)));
}
}
