// Settings as the viewer shows them: those that affect a mode's image, in groups, with slider ranges.
#pragma once
#include "modes/settings.h"

namespace tyndall {
struct Mode;

struct SettingGroup {
    std::string title;
    std::vector<const SettingRow*> rows;
};

// Groups of a mode: its own settings first, then the light's terms, multiple scattering, style and pixels.
std::vector<SettingGroup> setting_groups(const Mode& mode);

// The part of a setting's range that its slider covers: around the usual value if the whole range spans many powers of
// ten, and always including the value itself.
struct SliderRange {
    double low = 0, high = 1;
    bool logarithmic = false;
};
SliderRange slider_range(const SettingRow& row, double usual, double value);

// "depth slices" of froxel.depth_slices.
std::string label_of(const SettingRow& row);
}
