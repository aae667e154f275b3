// What a scene makes of the numbers in a grid: scale and offset, limits, a table; or a level set as fog.
#pragma once
#include "base/math.h"

#include <string>
#include <vector>

namespace tyndall {
struct ValueMap {
    float scale = 1, offset = 0;
    Interval<float> clamp{-infinity, infinity};
    std::vector<vec2>
        table;       // value and what becomes of it, ascending; straight between, the ends hold; empty = as it is
    float width = 0; // above 0: of a level set, clamp(-distance / width, 0, 1) before all else

    // table(clamp(scale · value + offset)); what is not a number stays so.
    float operator()(float value) const;
    bool changes_nothing() const;
    std::string text() const; // the same for the same map, in keys
};
}
