// Legends of false-color images.
#pragma once
#include <imgui.h>

namespace tyndall {
// Draws the color scale of the error with its upper left corner at `low`; returns its height.
float draw_error_legend(ImVec2 low, float width);

// Draws the color scale of stops from middle gray.
void draw_stops_legend(ImVec2 low, float width);
}
