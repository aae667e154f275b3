// Legends of false colours on a picture.
#pragma once
#include <imgui.h>

namespace tyndall {
// The scale of the error's colours from `low` to the right, as wide as `width`; returns its height.
float draw_error_legend(ImVec2 low, float width);

// That of false colours, in stops from middle grey.
void draw_stops_legend(ImVec2 low, float width);
}
