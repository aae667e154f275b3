// Plots over distance, drawn with ImGui.
#pragma once
#include "volume/bricks/brick_walk.h"

#include <imgui.h>

#include <span>
#include <string>

namespace tyndall {
// Values 0..y_end over a range of distances, from the lower left to the upper right.
struct Plot {
    ImVec2 low{0, 0}, high{0, 0}; // upper left, lower right
    Interval<double> range;
    double y_end = 1;

    float x(double distance) const;
    float y(double value) const;
    ImVec2 at(double distance, double value) const { return {x(distance), y(value)}; }
};

// Grid lines and labels at round values; with percents, values are fractions labeled in percent.
void draw_grid(const Plot& plot, bool percents);
void draw_distances(const Plot& plot, float top);

void draw_words(ImVec2 at, const ImVec4& color, const std::string& text);
}
