// Light icons and handles over the image, for selecting and moving lights.
#pragma once
#include "panels.h"
#include <imgui.h>

namespace tyndall {
// Rectangle of the whole image in the window, pixels; low is the upper left.
struct ImageRect {
    ImVec2 low, high;
    float height() const { return high.y - low.y; }
};

// Call after the item that takes the mouse on the image. Returns true while a light has the mouse, so that the camera
// stays.
bool draw_handles(const ViewState& state, ivec2 size, const ImageRect& place, EditState& edits, const Act& act);
}
