#include "viewer/state/setting_groups.h"

#include "base/error.h"
#include "base/text.h"
#include "modes/mode.h"

#include <algorithm>
#include <cmath>

namespace tyndall {
namespace {
constexpr double wide = 1e3; // high over low of a range that is cut to what is worth a slider
constexpr double reach = 16; // times the usual value and below it, on such a slider

// What a row's name begins with: radial_blur of radial_blur.samples.
std::string_view owner(const SettingRow& row) { return std::string_view(row.name).substr(0, row.name.find('.')); }

SettingGroup group_of(std::string title, std::string_view prefix) {
    SettingGroup group{std::move(title), {}};
    for (const SettingRow& row : setting_rows())
        if (owner(row) == prefix) group.rows.push_back(&row);
    return group;
}
}

std::vector<SettingGroup> setting_groups(const Mode& mode) {
    std::string prefix(mode.name);
    std::ranges::replace(prefix, '-', '_');
    std::vector<SettingGroup> groups{group_of(std::string(mode.name), prefix)};
    if (honours_style(mode)) groups.push_back(group_of("style", "style"));
    if (mode.adds_fluence) groups.push_back(group_of("light scattered before", "fluence"));
    if (mode.surfaces != Surfaces::own && prefix != "march") groups.push_back(group_of("terms of the light", "march"));
    groups.push_back(group_of("pixels", "pixel"));
    return groups;
}

const SettingRow& find_row(std::string_view name) {
    std::vector<std::string> names;
    for (const SettingRow& row : setting_rows()) {
        if (row.name == name) return row;
        names.push_back(row.name);
    }
    fail(ExitCode::usage, printable(name, 60), "no such setting; did you mean " + nearest_name(name, names) + "?");
}

SliderRange slider_range(const SettingRow& row, double usual, double value) {
    SliderRange range{row.low, row.high, row.low > 0 && row.high > wide * row.low};
    if (row.high > wide * row.low && usual > 0 && row.high > reach * usual) {
        if (row.low > 0) range.low = std::max(row.low, usual / reach);
        range.high = usual * reach;
        if (row.integer) range.low = std::floor(range.low), range.high = std::ceil(range.high);
    }
    range.low = std::min(range.low, value), range.high = std::max(range.high, value);
    return range;
}

std::string label_of(const SettingRow& row) {
    std::string label = row.name.substr(row.name.find('.') + 1);
    std::ranges::replace(label, '_', ' ');
    return label;
}
}
