// A scene's mapping of grid values: scale and offset, limits and a table, or conversion of a level set to fog.
#pragma once
#include "base/math.h"

#include <string>
#include <vector>

namespace tyndall {
struct ValueMap {
    float scale = 1, offset = 0;
    Interval<float> clamp{-infinity, infinity};
    std::vector<vec2> table; // (value, result), ascending; linear between, clamped at the ends; empty = identity
    float width = 0;         // above 0: level set, converted first by clamp(-distance / width, 0, 1)

    // table(clamp(scale · value + offset)); NaN is passed through.
    float operator()(float value) const;
    bool changes_nothing() const;
    std::string text() const; // identifies the map in cache keys; empty for the identity
};
}
