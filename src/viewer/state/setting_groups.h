// Settings as the viewer shows them: those that change a mode's picture, in groups, over ranges fit for a hand.
#pragma once
#include "modes/settings.h"

namespace tyndall {
struct Mode;

struct SettingGroup {
    std::string title;
    std::vector<const SettingRow*> rows;
};

// Groups of a mode: its own settings first, then style, scattering orders, the light's terms and pixels.
std::vector<SettingGroup> setting_groups(const Mode& mode);

// A row by name; throws Error (usage) naming the nearest one.
const SettingRow& find_row(std::string_view name);

// The part of a number's range worth a slider: around the usual value where the whole range spans many powers of ten,
// and always with the value itself in it.
struct SliderRange {
    double low = 0, high = 1;
    bool logarithmic = false;
};
SliderRange slider_range(const SettingRow& row, double usual, double value);

// "depth slices" of froxel.depth_slices.
std::string label_of(const SettingRow& row);
}
