#include "volume/value_map.h"

#include "base/text.h"

#include <algorithm>

namespace tyndall {
namespace {
float looked_up(const std::vector<vec2>& table, float value) {
    const auto above = std::ranges::upper_bound(table, value, {}, [](vec2 entry) { return entry.x; });
    if (above == table.begin()) return table.front().y;
    if (above == table.end()) return table.back().y;
    const vec2 low = *(above - 1), high = *above;
    return low.y + (high.y - low.y) * ((value - low.x) / (high.x - low.x));
}
}

float ValueMap::operator()(float value) const {
    if (std::isnan(value)) return value;
    if (width > 0) value = std::clamp(-value / width, 0.0f, 1.0f);
    value = std::clamp(scale * value + offset, clamp.low, clamp.high);
    return table.empty() ? value : looked_up(table, value);
}

bool ValueMap::changes_nothing() const {
    return scale == 1 && offset == 0 && clamp.low == -infinity && clamp.high == infinity && table.empty() && width == 0;
}

std::string ValueMap::text() const {
    if (changes_nothing()) return {};
    std::string text;
    const auto add = [&](float value) { text += formatted(" %a", static_cast<double>(value)); };
    for (const float value : {scale, offset, clamp.low, clamp.high, width}) add(value);
    for (const vec2 entry : table) add(entry.x), add(entry.y);
    return text;
}
}
