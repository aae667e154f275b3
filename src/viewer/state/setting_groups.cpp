#include "viewer/state/setting_groups.h"

#include "modes/mode.h"

#include <algorithm>
#include <cmath>

namespace tyndall {
namespace {
constexpr double wide = 1e3; // ratio of high to low above which a slider shows only part of a range
constexpr double reach = 16; // factor above and below the usual value on such a slider

// Adds the group of the rows with a prefix that the mode reads.
void append_group(const Mode& mode, std::string title, std::string_view prefix, std::vector<SettingGroup>& groups) {
    SettingGroup group{std::move(title), {}};
    for (const SettingRow& row : setting_rows())
        if (row.name.substr(0, row.name.find('.')) == prefix && reads(mode, row.name)) group.rows.push_back(&row);
    if (!group.rows.empty()) groups.push_back(std::move(group));
}
}

std::vector<SettingGroup> setting_groups(const Mode& mode) {
    std::vector<SettingGroup> groups;
    append_group(mode, std::string(mode.name), row_prefix(mode), groups);
    append_group(mode, "terms", "terms", groups);
    append_group(mode, "multiple scattering", "fluence", groups);
    append_group(mode, "style", "style", groups);
    append_group(mode, "pixels", "pixel", groups);
    return groups;
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
