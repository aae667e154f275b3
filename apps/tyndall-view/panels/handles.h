// Lights drawn over the picture, to be selected and moved.
#pragma once
#include "panels.h"
#include <imgui.h>

namespace tyndall {
// Where the whole picture lies in the window.
struct PicturePlace {
    ImVec2 low, high;
    float height() const { return high.y - low.y; }
};

// Call after the item that takes the mouse on the picture. True when the lights have the mouse: the camera stays.
bool draw_handles(const ViewState& state, ivec2 size, const PicturePlace& place, EditMemory& memory, const Act& act);
}
